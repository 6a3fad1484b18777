"""A case given as a dict, as the text of a case file."""

import json
import numbers
import re


def to_toml(case):
    """The TOML text of a dict of sections.

    Parameters
    ----------
    case : dict
        As a case file is read: strings, numbers, booleans, lists and dicts of these; numpy's as well.

    Returns
    -------
    str
        With one line for each key of a section, in the order of the dict.

    Raises
    ------
    ValueError
        That names the key whose value TOML has no word for.
    """
    plain = [(key, value) for key, value in case.items() if not isinstance(value, dict)]
    sections = [(key, value) for key, value in case.items() if isinstance(value, dict)]
    lines = [f"{_key(key)} = {_value(value, key)}" for key, value in plain]
    for name, section in sections:
        lines.append(f"[{_key(name)}]")
        lines += [f"{_key(key)} = {_value(value, f'{name}.{key}')}" for key, value in section.items()]
    return "\n".join(lines) + "\n"


def _key(key):
    if not isinstance(key, str):
        raise ValueError(f"{key!r}: expected a key that is a string")
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else _text(key)


def _text(text):
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(value, name):
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
        return "{ " + ", ".join(f"{_key(k)} = {_value(v, f'{name}.{k}')}" for k, v in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(item, name) for item in value) + "]"
    raise ValueError(f"{name}: expected a string, a number, true or false, a list or a dict, got {value!r}")
