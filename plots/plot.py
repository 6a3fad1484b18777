"""Draws a folder of results; `arcslip plot` runs it. Exit status: 0 done, 1 wrong input, 2 wrong command line, 4 a
picture could not be written, 5 there is no matplotlib."""

import argparse
import logging
import math
import os
import sys

os.environ.setdefault("SOURCE_DATE_EPOCH", "0")  # the date in EPS
os.environ["MPLBACKEND"] = "Agg"
logging.getLogger("matplotlib").setLevel(logging.CRITICAL)  # a cache that cannot be written does not matter
sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))

FORMATS = ("png", "svg", "pdf", "eps")


def _printable(text):
    """On one line that a terminal does not obey."""
    return "".join(one if one.isprintable() else one.encode("unicode_escape").decode() for one in text)


def _range(text):
    axis, _, bounds = text.partition("=")
    try:
        low, high = (float(bound) for bound in bounds.split(":"))
    except ValueError:
        low = high = math.nan
    if axis not in ("x", "y") or not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise argparse.ArgumentTypeError(f"expected x=LOW:HIGH or y=LOW:HIGH with LOW < HIGH, got {text}")
    return axis, (low, high)


def _size(text):
    try:
        width, height = (float(length) for length in text.split("x"))
    except ValueError:
        width = height = math.nan
    if not (4 <= width <= 100 and 4 <= height <= 100):
        raise argparse.ArgumentTypeError(f"expected WIDTHxHEIGHT in cm, both from 4 to 100, got {text}")
    return width, height


def _arguments():
    parser = argparse.ArgumentParser(prog="arcslip plot", allow_abbrev=False)
    parser.error = lambda message: (print(f"arcslip plot: {message}", file=sys.stderr), sys.exit(2))
    parser.add_argument("folder")
    parser.add_argument("--x")
    parser.add_argument("--y", action="append", default=[])
    parser.add_argument("--log", action="append", default=[], choices=("x", "y", "xy"))
    parser.add_argument("--linear", action="append", default=[], choices=("x", "y", "xy"))
    parser.add_argument("--range", action="append", default=[], type=_range)
    parser.add_argument("--size", type=_size)
    parser.add_argument("--format", action="append", default=[], choices=FORMATS)
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--release", default="")
    return parser.parse_args()


def main():
    given = _arguments()
    try:
        import matplotlib
    except ImportError:
        return 5
    from pictures import Options, Refused, draw_folder

    options = Options(given.x, given.y, set("".join(given.log)), set("".join(given.linear)), dict(given.range), given.size,
                      given.format or ["png", "svg"], given.only)
    try:
        for path in draw_folder(given.folder, options, given.release):
            print(path)
    except Refused as refused:
        print(_printable(str(refused)), file=sys.stderr)
        return 1
    except OSError as error:
        print(_printable(str(error)), file=sys.stderr)
        return 4
    return 0


if __name__ == "__main__":
    sys.exit(main())
