"""Draws what `arcslip run`, `study` and `modes` have written. Reads their tables and JSON, nothing else.

The program runs plot.py beside this package; the Python module has a copy of it.
"""

from .folder import Options, draw_folder
from .tables import Refused

__all__ = ["Options", "Refused", "draw_folder"]
