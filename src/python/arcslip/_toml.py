"""A case given as a dict, as the text of a case file."""

import io
import json
import numbers
import re

import numpy as np

from ._element import Element
from ._structure import Structure


class Parts:
    """What a dict holds that TOML has no word for, by the names that stand for it.

    Attributes
    ----------
    files : dict
        Texts of matrices, as Matrix Market files have them.
    elements : list of Element
    structures : dict of Structure
    """

    def __init__(self):
        self.files = {}
        self.elements = []
        self.structures = {}

    def matrix(self, given, name):
        """The name under which a matrix goes."""
        label = f"<array {name}>"
        self.files[label] = _matrix_market(given, name)
        return label

    def element(self, given):
        """The name of its kind."""
        if all(given is not one for one in self.elements):
            if any(given.kind == one.kind for one in self.elements):
                raise ValueError(f"element '{given.kind}': two different ones have this name")
            self.elements.append(given)
        return given.kind

    def structure(self, given):
        """The name of its model."""
        if self.structures.get(given.name, given) is not given:
            raise ValueError(f"structure '{given.name}': two different ones have this name")
        self.structures[given.name] = given
        return given.name


def _matrix_market(given, name):
    if hasattr(given, "tocoo"):
        entries = given.tocoo()
        entries.sum_duplicates()
        rows, columns, values = entries.row, entries.col, entries.data
    else:
        given = np.asarray(given)
        rows, columns = np.nonzero(given)
        values = given[rows, columns]
    if values.dtype.kind not in "fiub":
        raise ValueError(f"{name}: expected a matrix of real numbers, got {values.dtype}")
    out = io.StringIO()
    out.write(f"%%MatrixMarket matrix coordinate real general\n{given.shape[0]} {given.shape[1]} {len(values)}\n")
    np.savetxt(out, np.column_stack([rows + 1, columns + 1, values]), fmt=("%d", "%d", "%.17g"))
    return out.getvalue()


def to_toml(case):
    """The TOML text of a dict of sections, and what else it holds.

    Parameters
    ----------
    case : dict
        As a case file is read: strings, numbers, booleans, lists and dicts of these; numpy's as well. Matrices of
        numpy, in two dimensions, and of scipy.sparse stand where the name of a file would, an `Element` where the
        name of a kind of element would, a `Structure` where that of a model would.

    Returns
    -------
    (str, Parts)
        The text with one line for each key of a section, in the order of the dict.

    Raises
    ------
    ValueError
        That names the key whose value TOML has no word for.
    """
    plain = [(key, value) for key, value in case.items() if not isinstance(value, dict)]
    sections = [(key, value) for key, value in case.items() if isinstance(value, dict)]
    parts = Parts()
    lines = [f"{_key(key)} = {_value(value, key, parts)}" for key, value in plain if not _is_tables(value)]
    for name, section in sections:
        lines.append(f"[{_key(name)}]")
        lines += [f"{_key(key)} = {_value(value, f'{name}.{key}', parts)}" for key, value in section.items()]
    for name, tables in plain:
        for i, table in enumerate(tables if _is_tables(tables) else ()):
            lines.append(f"[[{_key(name)}]]")
            lines += [f"{_key(key)} = {_value(value, f'{name}[{i}].{key}', parts)}" for key, value in table.items()]
    return "\n".join(lines) + "\n", parts


def _is_tables(value):
    return isinstance(value, list) and len(value) > 0 and all(isinstance(one, dict) for one in value)


def _key(key):
    if not isinstance(key, str):
        raise ValueError(f"{key!r}: expected a key that is a string")
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else _text(key)


def _text(text):
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(value, name, parts):
    if isinstance(value, Element):
        return _text(parts.element(value))
    if isinstance(value, Structure):
        return _text(parts.structure(value))
    if hasattr(value, "tocoo") or np.ndim(value) == 2 and isinstance(value, np.ndarray):
        return _text(parts.matrix(value, name))
    if hasattr(value, "tolist"):  # of numpy
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        return repr(float(value))
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(k)} = {_value(v, f'{name}.{k}', parts)}" for k, v in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(item, name, parts) for item in value) + "]"
    raise ValueError(f"{name}: expected a string, a number, true or false, a list or a dict, got {value!r}")
