"""Errors for calls whose arguments do not fit, which name the argument or function to use."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Mapping
from functools import partial, wraps
from numbers import Real
from typing import Any, ParamSpec, TypeVar, get_args, overload

import numpy as np

P = ParamSpec("P")
T = TypeVar("T")

_OMEGA, _TIMES = ("omega_body", "omega_space", "rates"), ("times", "duration")

# Words of other programs and text books, and the arguments that they can mean. Those of scenes are in
# `crates/rigid/src/scene/reader.rs`.
_OURS: dict[str, tuple[str, ...]] = {
    **dict.fromkeys(("omega", "angular_velocity", "angular_rate", "rates", "spin", "w"), _OMEGA),
    **dict.fromkeys(("attitude", "orientation", "rotation", "quaternion", "q"), ("rotor", "attitude")),
    **dict.fromkeys(("pos", "x0"), ("position", "state")),
    **dict.fromkeys(("y0", "initial", "initial_state", "start"), ("state",)),
    **dict.fromkeys(("t", "t0", "epoch"), ("time", "times")),
    **dict.fromkeys(("t_eval", "t_span", "t_end", "tmax", "end", "duration"), _TIMES),
    **dict.fromkeys(("dt", "h", "step_size", "timestep"), ("step", "height")),
    **dict.fromkeys(("tol", "tolerance", "reltol"), ("rtol",)),
    "abstol": ("atol",),
    **dict.fromkeys(("integrator", "solver"), ("method",)),
    **dict.fromkeys(("moment", "torques"), ("torque",)),
    **dict.fromkeys(("i", "j", "moments", "tensor"), ("inertia", "body")),
    "inertia": ("body",),
    **dict.fromkeys(("com", "cg", "cog", "center"), ("center_of_mass",)),
    **dict.fromkeys(("deg", "in_degrees"), ("degrees",)),
    **dict.fromkeys(("n", "num"), ("shape",)),
    **dict.fromkeys(("seed", "random_state"), ("rng",)),
    "scalar_first": ("order",),
    "assume_valid": ("nearest",),
    "pitch": ("distance",),
    **dict.fromkeys(("theta", "radians", "rad", "phi"), ("angle", "theta")),
    "angle": ("theta",),
    **dict.fromkeys(("sequence", "convention"), ("seq",)),
    **dict.fromkeys(("matrix", "dcm"), ("m",)),
    "quat": ("q",),
    "rotvec": ("v",),
    "m": ("mass",),
    "r": ("radius",),
    "rho": ("density",),
    **dict.fromkeys(("size", "sizes", "dimensions", "sides", "extents"), ("lengths", "shape")),
    **dict.fromkeys(("axes", "radii", "semiaxes"), ("semi_axes",)),
    "l": ("length", "height"),
    "length": ("height",),
    **dict.fromkeys(("unit", "units", "length_unit"), ("scale",)),
    **dict.fromkeys(("file", "filename", "mesh"), ("path",)),
    **dict.fromkeys(("n_jobs", "num_threads", "workers"), ("threads",)),
}


Message = Callable[[tuple[Any, ...], Mapping[str, Any], str], str]


@overload
def explains_calls(function: Callable[P, T], /) -> Callable[P, T]: ...


@overload
def explains_calls(**remedies: str) -> Callable[[Callable[P, T]], Callable[P, T]]: ...


def explains_calls(function: Any = None, /, **remedies: str) -> Any:
    """Make the TypeError for arguments that do not fit name the one that is probably meant, or all.

    `remedies` say what to write for an argument that the function does not have; the first one also for
    too many arguments by position.
    """
    if function is None:
        return partial(_explaining, remedies)
    return _explaining(remedies, function)


def _explaining(remedies: Mapping[str, str], function: Callable[P, T]) -> Callable[P, T]:
    # The name of the result may change: methods of values are functions under another name.
    def message(given: tuple[Any, ...], named: Mapping[str, Any], error: str) -> str:
        return _misfit(explained, remedies, named, error) + _as_a_list(explained, given, error)

    explained = _with_message(function, message)
    return explained


def _as_a_list(function: Callable[..., Any], arguments: tuple[Any, ...], error: str) -> str:
    """Return the end of the message for numbers as several arguments, such as components or angles."""
    count = next((k for k, x in enumerate(reversed(arguments)) if not isinstance(x, Real)), len(arguments))
    kinds = [x.kind for x in inspect.signature(function).parameters.values()]
    most = kinds.count(inspect.Parameter.POSITIONAL_OR_KEYWORD)
    # The list is the last argument, or the one before it.
    if count < 3 or not re.search(r"positional .* given", error) or most > len(arguments) - count + 2:
        return ""
    return f"; pass numbers as one list, [{', '.join(map(repr, arguments[-count:]))}]"


def takes_components(function: Callable[P, T]) -> Callable[P, T]:
    """Make the TypeError for components as several arguments, or by name, show the call with a list."""

    def message(arguments: tuple[Any, ...], named: Mapping[str, Any], error: str) -> str:
        method = "self" in inspect.signature(function).parameters
        name, values = function.__name__, arguments[1:] if method else arguments
        call = f"{'A' if method else 'ph'}.{name}"
        if len(values) > 1 and all(isinstance(x, Real) for x in values):
            return f"{name} takes one list of components; write {call}([{', '.join(map(repr, values))}])"
        if len(values) > 1 and all(np.ndim(x) and np.shape(x) == np.shape(values[0]) for x in values):
            return f"{name} takes one array of components; write {call}(np.stack([x, y, …], axis=-1))"
        if named and all(re.fullmatch(r"e\d+", key) for key in named):
            algebra = "A" if method else "ph.algebra(3)"
            terms = " + ".join(f'{x!r} * {algebra}.blades["{key}"]' for key, x in named.items())
            return f"{name} takes no components by name; write {terms}"
        return _misfit(function, {}, named, error)

    return _with_message(function, message)


def explains_calls_of(kind: type[T]) -> type[T]:
    """Make the constructor and the public static methods of a class explain arguments that do not fit."""
    for name, member in list(vars(kind).items()):
        if name == "__init__":
            setattr(kind, name, explains_calls(member))
        elif isinstance(member, staticmethod) and not name.startswith("_"):
            if "." not in member.__func__.__qualname__:  # a function of a module
                member.__func__.__qualname__ = f"{kind.__name__}.{name}"
            setattr(kind, name, staticmethod(explains_calls(member.__func__)))
    return kind


def _misfit(
    function: Callable[..., Any], remedies: Mapping[str, str], named: Mapping[str, Any], error: str
) -> str:
    """Return the message for a call with keywords whose arguments do not fit, from that of Python."""
    import difflib  # here, because it takes a millisecond of the import

    wanted = inspect.signature(function).parameters
    shown = [x for name, x in wanted.items() if name != "self" and not name.startswith("_")]
    names = [x.name for x in shown]
    remedy = f"its arguments are {_listed(shown)}{_values(function, shown)}"
    unknown = [name for name in named if name not in wanted]
    if not unknown:
        if remedies and "positional" in error and "given" in error:
            remedy = f"write {next(iter(remedies.values()))}"
        own = function.__qualname__.removesuffix(".__init__")
        if "self" in wanted:
            error = _without_self(error)
        return re.sub(r"^[\w.<>]+\(\)", f"{own}()", error) + f"; {remedy}"
    meant = [ours for ours in _OURS.get(unknown[0].lower(), ()) if ours in names]
    if unknown[0] in remedies:
        remedy = f"write {remedies[unknown[0]]}"
    elif meant := meant or difflib.get_close_matches(unknown[0].lower(), names, 1):
        values = _values(function, [x for x in shown if x.name in meant])
        remedy = f"write {' or '.join(f'{ours}=' for ours in meant)}{values}"
    title = function.__qualname__.removesuffix(".__init__")
    return f"{title} has no argument {unknown[0]!r}; {remedy}"


def _without_self(error: str) -> str:
    """Return Python's message for too many arguments, with numbers that do not count the object itself."""
    counts = re.search(r"takes (?:from \d+ to )?\d+ positional arguments? but \d+ (?:was|were) given", error)
    if not counts:
        return error
    fewer = re.sub(r"\d+", lambda number: str(int(number[0]) - 1), counts[0])
    fewer = re.sub(r"(?<!to )\b1 positional arguments", "1 positional argument", fewer)
    fewer = re.sub(r"\b0 positional argument\b", "0 positional arguments", fewer)
    return error.replace(counts[0], fewer.replace("but 1 were given", "but 1 was given"))


def _listed(parameters: list[inspect.Parameter]) -> str:
    return str(inspect.Signature([x.replace(annotation=inspect.Parameter.empty) for x in parameters]))


def _values(function: Callable[..., Any], parameters: list[inspect.Parameter]) -> str:
    """Return the values that required arguments can have, if they are few."""
    scope = getattr(inspect.unwrap(function), "__globals__", {})
    required = [x for x in parameters if x.default is inspect.Parameter.empty]
    few = {x.name: get_args(scope.get(x.annotation)) for x in required}
    return "".join(f", with {name}={' or '.join(map(repr, x))}" for name, x in few.items() if x)


def created_by(remedy: str) -> Callable[[type[T]], type[T]]:
    """Make the TypeError of a constructor that users do not call name the functions to use."""

    def explained(kind: type[T]) -> type[T]:
        message = f"{kind.__name__} has no public constructor; use {remedy}"
        init: Any = kind.__init__
        explained_init = _with_message(init, lambda *_: message)
        setattr(kind, "__init__", explained_init)  # noqa: B010, a type checker knows the original
        return kind

    return explained


def _with_message(function: Callable[P, T], message: Message) -> Callable[P, T]:
    """Replace the TypeError for arguments that do not fit, given these arguments and Python's message."""

    @wraps(function)
    def call(*arguments: P.args, **named: P.kwargs) -> T:
        try:
            return function(*arguments, **named)
        except TypeError as error:
            if _fit(function, *arguments, **named):
                raise
            text = message(arguments, named, str(error))
        raise TypeError(text)

    return call


def _fit(function: Callable[..., Any], *arguments: Any, **named: Any) -> bool:
    """Whether the function takes these arguments."""
    try:
        inspect.signature(function).bind(*arguments, **named)
    except TypeError:
        return False
    return True
