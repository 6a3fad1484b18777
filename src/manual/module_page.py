"""The page of the Python module, made of its docstrings."""

import inspect
import re


def as_markdown(text):
    """A docstring in numpy's convention: sections in bold, what they list as a list."""
    lines = inspect.cleandoc(text).split("\n")
    made, listing = [], False
    for number, line in enumerate(lines):
        underlined = number + 1 < len(lines) and re.fullmatch(r"-{3,}", lines[number + 1])
        if underlined:
            listing = True
            made += ["", f"**{line}**", ""]
        elif re.fullmatch(r"-{3,}", line):
            continue
        elif listing and line and not line.startswith(" "):
            made.append(f"- `{line}`")
        else:
            made.append(line)
    return "\n".join(made)


def entry(name, one, heading):
    """A heading, the signature and the docstring of one function, method, property or class."""
    if isinstance(one, property):
        shown = name
    else:
        shown = name + str(inspect.signature(one)).replace("(self, ", "(").replace("(self)", "()")
    return f"{heading} {name}\n\n```text\n{shown}\n```\n\n{as_markdown(inspect.getdoc(one) or '')}\n"


def module_page():
    """All that the module offers, in the order of its names, classes with their members."""
    import arcslip

    parts = [f"# Python module\n\nMade of the docstrings of arcslip {arcslip.__version__}.\n", as_markdown(arcslip.__doc__)]
    for name in arcslip.__all__:
        one = getattr(arcslip, name)
        if not callable(one):
            continue
        parts.append(entry(name, one, "##"))
        if inspect.isclass(one):
            for member, what in vars(one).items():
                if not member.startswith("_") and (inspect.isfunction(what) or isinstance(what, property)):
                    parts.append(entry(f"{name}.{member}", what, "###"))
    return "\n".join(parts)
