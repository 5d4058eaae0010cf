"""Raises readable errors for wrong arguments. If an argument has a wrong type, a compiled function
lists all its signatures. A wrapped function says instead which argument is wrong, what was expected
and what was given."""
import ast
import difflib
import functools
import inspect
import math
import operator
import re
import types

_OPTIONAL = r"Optional\[(.*)\]"
_LIST = r"(?:List|list|Sequence)\[([\w.]+)(?:\[(\d+)\])?\]"
_PAIR = r"(?:Tuple|tuple)\[int, int\]"
_MANY = {"int": "whole numbers", "float": "numbers", "str": "texts"}
_WORDS = {
    "int": "a whole number",
    "float": "a number",
    "str": "a text",
    "bool": "True or False",
    "object": "any object",
    "dict": "a dict",
    "list": "a list",
    "tuple": "a tuple",
    "bytes": "bytes",
    "None": "None"
}


# How pybind11 3 writes types, and how pybind11 2 does.
_NEWER = [(re.compile(pattern), text) for pattern, text in (
    (r"\b(typing|collections\.abc)\.", ""),
    (r"SupportsFloat \| SupportsIndex", "float"),
    (r"SupportsInt \| SupportsIndex", "int"),
    (r'Annotated\[\w+\[(\w+)\], "FixedSize\((\d+)\)"\]', r"List[\1[\2]]"),
    (r"^(.*) \| None$", r"Optional[\1]"),
)]


def _plain(kind):
    """Returns a type as pybind11 2 writes it."""
    for pattern, text in _NEWER:
        kind = pattern.sub(text, kind)
    return kind


def _split(text):
    """Splits "a: int, b: Tuple[int, int] = (1, 2)" at the commas outside of brackets."""
    parts, depth, quote = [""], 0, ""
    for c in text:
        if quote:
            quote = "" if c == quote else quote
        elif c in "'\"":
            quote = c
        elif c in "[(<{":
            depth += 1
        elif c in "])>}":
            depth -= 1
        elif c == "," and depth == 0:
            parts.append("")
            continue
        parts[-1] += c
    return [p.strip() for p in parts if p.strip()]


def _signature(doc):
    """Parses the first line of a compiled function's docstring. Returns {name: type as text} and
    the set of names with a default; None if the line is not a signature."""
    found = re.match(r"\w+\((.*)\) -> ", (doc or "").strip().split("\n")[0])
    if not found:
        return None
    names, optional = {}, set()
    for part in _split(found[1]):
        name, _, kind = part.partition(":")
        kind, default, _ = kind.partition(" = ")
        if not name.startswith("*"):
            names[name.strip()] = _plain(kind.strip())
        if default:
            optional.add(name.strip())
    return names, optional


def _describe(kind):
    optional = re.fullmatch(_OPTIONAL, kind)
    if optional:
        return f"{_describe(optional[1])} or None"
    several = re.fullmatch(_LIST, kind)
    if several:
        return f"{several[2] or 'a list of'} {_MANY.get(several[1], several[1].split('.')[-1] + 's')}"
    if re.fullmatch(_PAIR, kind):
        return "2 whole numbers"
    name = kind.split("[")[0].split(".")[-1]
    return _WORDS.get(name, f"a {name}")


def _fits(value, kind):
    """Returns whether a value matches a type given as text. Returns True if the text does not
    say."""
    optional = re.fullmatch(_OPTIONAL, kind)
    if optional:
        return value is None or _fits(value, optional[1])
    several = re.fullmatch(_LIST, kind)
    if several or re.fullmatch(_PAIR, kind):
        try:
            good = not isinstance(value, (str, bytes, dict)) and all(
                _fits(v, several[1] if several else "int") for v in value)
            return good and len(value) == int(several[2] or len(value) if several else 2)
        except TypeError:
            return False
    if kind in ("int", "float"):
        try:
            operator.index(value) if kind == "int" else _real(value)
        except TypeError:
            return False
        return True
    if kind == "bool":
        return type(value).__name__ in ("bool", "bool_") or (isinstance(value, int) and
                                                             value in (0, 1))
    if kind in ("str", "dict", "bytes"):
        return isinstance(value, {"str": str, "dict": dict, "bytes": bytes}[kind])
    name = kind.split(".")[-1]
    if kind.startswith("xvrml") and name.isidentifier():
        return any(c.__name__ == name for c in type(value).__mro__)
    return True


def _short(value):
    text = repr(value)
    text = text if len(text) <= 40 else text[:37] + "..."
    return text if value is None or isinstance(value,
                                               bool) else f"the {type(value).__name__} {text}"


def sentence(function, args, kwargs):
    """Returns a sentence that says what is wrong with the arguments of a compiled function; None if
    its signature is unknown."""
    parsed = _signature(function.__doc__)
    if not parsed:
        return None
    names, optional = parsed
    name = function.__name__ if function.__name__ != "__init__" else names["self"].split(".")[-1]
    order = list(names)
    shown = [n for n in order if n != "self"]
    for given in kwargs:
        if given not in names:
            near = difflib.get_close_matches(given, shown, 1)
            return f"{name}(): there is no argument {given}" + (
                f"; did you mean {near[0]}?" if near else f" (there are: {', '.join(shown)})")
    for position, value in enumerate(args):
        if position >= len(order):
            return f"{name}(): {len(args)} arguments were given, at most {len(order)} can be; the rest go by name"
        if not _fits(value, names[order[position]]):
            return f"{name}(): {order[position]}: {_describe(names[order[position]])} expected, not {_short(value)}"
    for given, value in kwargs.items():
        if not _fits(value, names[given]):
            return f"{name}(): {given}: {_describe(names[given])} expected, not {_short(value)}"
    missing = [
        n for n in order[len(args):] if n not in kwargs and n not in optional and n != "self"
    ]
    if missing:
        return f"{name}(): {' and '.join(missing)} must be given"
    for given, value in [*zip(order, args), *kwargs.items()]:  # the types are right
        for one in [value] if names[given] in (
                "int", "Optional[int]") else value if re.fullmatch(_PAIR, names[given]) else []:
            if one is not None and abs(operator.index(one)) >= 1 << 31:
                return f"{name}(): {given}: a number nearer to 0 expected, not {_short(one)}"
    return f"{name}(): the arguments do not fit {name}({', '.join(shown)})"


class _Default:
    """A default value of a compiled function that is no literal of Python."""

    def __init__(self, text):
        self._text = text

    def __repr__(self):
        return self._text


def _default(text):
    try:
        return ast.literal_eval(text)
    except (ValueError, SyntaxError):
        return {"inf": math.inf, "nan": math.nan}.get(text, _Default(text))


def _inspectable(doc):
    """Returns the signature that the docstring of a compiled function begins with, for
    inspect.signature() and editors; None if it begins with none."""
    found = re.match(r"\w+\((.*)\)(?: -> (.*))?", (doc or "").strip().split("\n")[0])
    if not found:
        return None
    parameters, kind = [], inspect.Parameter.POSITIONAL_OR_KEYWORD
    for part in _split(found[1]):
        name, _, type_and_default = part.partition(":")
        if name.startswith("*"):
            kind = inspect.Parameter.KEYWORD_ONLY
            if name != "*":
                parameters.append(
                    inspect.Parameter(
                        name.strip("*"), inspect.Parameter.VAR_KEYWORD
                        if name.startswith("**") else inspect.Parameter.VAR_POSITIONAL))
            continue
        annotation, equals, default = type_and_default.partition(" = ")
        if not name.strip().isidentifier():
            return None
        parameters.append(
            inspect.Parameter(name.strip(),
                              kind,
                              default=_default(default) if equals else inspect.Parameter.empty,
                              annotation=annotation.strip() or inspect.Parameter.empty))
    try:
        return inspect.Signature(parameters, return_annotation=found[2] or inspect.Signature.empty)
    except ValueError:  # the order is one that Python's functions do not have
        return None


def _wrapped(function):

    @functools.wraps(function)
    def call(*args, **kwargs):
        try:
            return function(*args, **kwargs)
        except TypeError as error:
            if "incompatible" not in str(error) or "arguments" not in str(error):
                raise
            message = sentence(function, args, kwargs)
            if not message:
                raise
        raise TypeError(message)

    signature = _inspectable(function.__doc__)
    if signature is not None:
        call.__signature__ = signature
    return call


def _wrapped_setter(cls, name, setter):
    """Wraps a property's setter, whose docstring has no name, and "arg1" for the value."""
    kind = re.search(r"arg1: (.*)\) -> ", setter.__doc__ or "")

    @functools.wraps(setter)
    def assign(self, value):
        try:
            return setter(self, value)
        except TypeError as error:
            if not kind or "incompatible" not in str(error):
                raise
        raise TypeError(
            f"{cls.__name__}.{name}: {_describe(_plain(kind[1]))} expected, not {_short(value)}")

    return assign


def _compiled(value):
    return type(value).__name__ in ("instancemethod", "builtin_function_or_method") or isinstance(
        value, types.BuiltinFunctionType)


def explain_class(cls):
    """Wraps the compiled methods and property setters of a class."""
    for name, value in list(vars(cls).items()):
        if isinstance(value, property) and value.fset and _compiled(value.fset):
            setattr(
                cls, name,
                property(value.fget, _wrapped_setter(cls, name, value.fset), value.fdel,
                         value.__doc__))
        if name in ("__new__", "__getattr__", "__setattr__") or not _compiled(value):
            continue
        setattr(cls, name, _wrapped(inspect.unwrap(getattr(cls, name))))


def _real(value):
    if isinstance(value, (str, bytes)):
        raise TypeError
    return float(value)


def number(name, value, above=None):
    """Checks that an argument is a finite number, and above a bound if one is given. Returns a
    float."""
    expected = "a number" if above is None else f"a number above {above}"
    try:
        made = _real(value)
    except (TypeError, ValueError):
        raise TypeError(f"{name}: {expected} expected, not {_short(value)}") from None
    except OverflowError:
        made = math.inf
    if not math.isfinite(made):
        raise ValueError(f"{name}: a finite number expected, not {_short(value)}")
    if above is not None and not made > above:
        raise ValueError(f"{name}: {expected} expected, not {_short(value)}")
    return made


def whole(name, value, low=1, high=None):
    """Checks that an argument is a whole number from low to high. Returns an int."""
    try:
        made = operator.index(value)
    except TypeError:
        raise TypeError(f"{name}: a whole number expected, not {_short(value)}") from None
    if made < low or (high is not None and made > high):
        span = "above 0" if (low, high) == (
            1, None) else f"from {low} on" if high is None else f"from {low} to {high}"
        raise ValueError(f"{name}: a whole number {span} expected, not {made}")
    return made


def explained(function):
    """Wraps a compiled function so that its errors are sentences."""
    return _wrapped(function)


def _expected(shape):
    sides = [str(side) if side is not None else "n" for side in shape if side is not ...]
    if shape[0] is ...:
        return f"numbers of shape (..., {', '.join(sides)})"
    return f"{sides[0]} numbers" if len(
        sides) == 1 and shape[0] else f"numbers of shape ({', '.join(sides)})"


def array(name, value, shape):
    """Returns the value as an array of numbers of any type. shape: its lengths; ... allows any
    number of dimensions in front, None any length. Raises TypeError for values that are not
    numbers, ValueError for another shape."""
    import numpy as np
    try:
        found = np.asarray(value)
        if found.size and found.dtype.kind not in "fiub":
            raise TypeError
    except (TypeError, ValueError):
        raise TypeError(f"{name}: {_expected(shape)} expected, not {_short(value)}") from None
    wanted = [side for side in shape if side is not ...]
    last = found.shape[found.ndim - len(wanted):] if found.ndim >= len(wanted) else None
    if last is None or (shape[0] is not ... and found.ndim != len(wanted)) or any(
            w not in (None, n) for w, n in zip(wanted, last)):
        raise ValueError(f"{name}: {_expected(shape)} expected, not of shape {found.shape}")
    return found


def numbers(name, value, shape, finite=True):
    """Returns array() as float64. Also raises ValueError for numbers that are not finite, unless
    finite is False."""
    import numpy as np
    found = array(name, value, shape).astype(np.float64)
    if finite and not np.isfinite(found).all():
        raise ValueError(f"{name}: {_expected(shape)} expected, all of them finite")
    return found
