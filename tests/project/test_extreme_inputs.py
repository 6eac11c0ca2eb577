"""Every public function takes numbers of any layout, size, shape and type, or says what is wrong."""

import inspect
import warnings

import numpy as np
import pytest

import algebra_calls
import kinds_of_input as kinds
import mechanics_calls
from public_names import methods, public

CALLS = algebra_calls.CALLS | mechanics_calls.CALLS
WITHOUT_NUMBERS = f"{algebra_calls.WITHOUT_NUMBERS} {mechanics_calls.WITHOUT_NUMBERS}".split()
# A fit takes half a second.
each = pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow if name == "fit" else ()) for name in CALLS]
)


def outcome(call, arguments):
    """The numbers of a result, or the type of the exception."""
    try:
        return list(kinds.held(call.f(*arguments)))
    except np.linalg.LinAlgError:  # a ValueError that names no value
        raise
    except (ValueError, TypeError) as error:
        return type(error)


def test_every_public_name_is_called():
    """A name that is missing here belongs into `CALLS` of one of the modules, or into `WITHOUT_NUMBERS`."""
    names = set(public())
    for name, found in public().items():
        if inspect.isclass(found):
            names |= {f"{name}.{method}" for method in methods(found)}
    assert not names - set(CALLS) - set(WITHOUT_NUMBERS)
    assert not {*CALLS, *WITHOUT_NUMBERS} - names
    assert not set(CALLS) & set(WITHOUT_NUMBERS)


@each
def test_memory_layouts_give_the_same_bits(name):
    call = CALLS[name]
    expected = outcome(call, call.arrays)
    assert isinstance(expected, list), expected
    for layout, changed in kinds.LAYOUTS.items():
        assert outcome(call, map(changed, call.arrays)) == expected, layout


@each
def test_whole_numbers_give_the_bits_of_floats(name):
    call = CALLS[name]
    whole = [np.rint(2 * array) + 0.0 for array in call.arrays]  # without −0
    assert outcome(call, [array.astype(np.int64) for array in whole]) == outcome(call, whole)


def run_each(name, changes):
    """Call a function with each change of each array; nothing but a ValueError or TypeError may be raised."""
    call = CALLS[name]
    for place, array in enumerate(call.arrays):
        for changed in changes(array):
            outcome(call, [*call.arrays[:place], changed, *call.arrays[place + 1 :]])


@each
def test_extreme_numbers(name):
    """Warnings are errors: a result beyond the range of floating point is infinite without one."""
    with warnings.catch_warnings():
        # Of steps that are too long, as `simulate` documents.
        warnings.filterwarnings("ignore", "with step = .* the body turns", RuntimeWarning)
        warnings.filterwarnings("ignore", ".* changes too fast for step", RuntimeWarning)
        warnings.filterwarnings("ignore", "the body does not fit", RuntimeWarning)
        run_each(name, kinds.extremes)


@each
def test_other_shapes(name):
    run_each(name, kinds.shapes)


@each
@pytest.mark.filterwarnings("ignore:invalid value encountered in cast")
@pytest.mark.filterwarnings("ignore:the body does not fit")
def test_other_types(name):
    run_each(name, kinds.types)
