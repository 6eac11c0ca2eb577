"""Arrays that hold the same numbers in another way, extreme numbers, and all numbers that a result holds."""

import dataclasses

import numpy as np

import polhode as ph


def _strided(array):
    wide = np.full((*array.shape, 2), -7.0)
    wide[..., 0] = array
    return wide[..., 0]


def _reversed(array):
    return np.ascontiguousarray(array[::-1])[::-1] if array.ndim else array


def _read_only(array):
    copy = array.copy()
    copy.flags.writeable = False
    return copy


def _unaligned(array):
    found = np.empty(array.nbytes + 1, np.uint8)[1:].view(np.float64).reshape(array.shape)
    found[...] = array
    return found


# The same numbers in other memory, all of which must give the same bits.
LAYOUTS = {
    "Fortran order": lambda a: np.asfortranarray(a) if a.ndim else a,
    "strided": _strided,
    "reversed": _reversed,
    "big-endian": lambda a: a.astype(">f8"),
    "read-only": _read_only,
    "unaligned": _unaligned,
    "long double": lambda a: a.astype(np.longdouble),
}
_SIZES = (1e-300, 1e-160, 1e-10, 1e10, 1e100, 1e160)
_TYPES = ("bool", "i1", "u8", "f2", "f4", "c16", "U5", "S3", "M8[s]", "object")
EXTREMES = (
    0.0,
    -0.0,
    5e-324,
    2.3e-308,
    1e-300,
    -1e-300,
    1e150,
    1e300,
    -1e300,
    1.8e308,
    np.nan,
    np.inf,
    -np.inf,
)


def extremes(array):
    """Yield arrays like this one with extreme numbers."""
    for x in EXTREMES:
        yield np.full_like(array, x)
        if array.ndim:
            one = array.copy()
            one.flat[array.size // 2] = x
            yield one
    yield from (array * size for size in _SIZES)


def shapes(array):
    """Yield numbers in other shapes: none, fewer, and more axes."""
    yield np.array(1.5)
    yield np.broadcast_to(array, (2, 3, *array.shape))
    yield np.zeros((0, *array.shape))
    if array.ndim:
        yield from (array[:0], array[..., :0], array[1:], array[..., 1:], array[np.newaxis])


def types(array):
    """Yield the numbers as arrays of other types, and arrays that hold no numbers."""
    with np.errstate(all="ignore"):
        changed = [array.astype(name) for name in _TYPES]
    yield from changed
    yield np.full(array.shape, None)
    yield np.zeros(array.shape, [("a", "f8")])
    yield np.ma.masked_array(array)


def held(result):
    """Yield the bytes of every number in a result, and texts."""
    if isinstance(result, np.ndarray | np.generic):
        if result.dtype == object:
            yield from (part for item in result.ravel() for part in held(item))
        else:
            yield str(result.dtype.newbyteorder("=")), result.shape, np.ascontiguousarray(result).tobytes()
    elif isinstance(result, ph.Multivector):
        yield type(result).__name__, result.grades
        yield from held(result.components)
    elif isinstance(result, ph.LinearMap):
        yield from held(result.matrix)
    elif isinstance(result, ph.RigidTransform):
        yield from held((result.rotor, result.translation))
    elif isinstance(result, ph.Body):
        yield from held((result.mass, result.inertia.matrix, result.center_of_mass))
    elif isinstance(result, ph.Trajectory):
        yield from held((result.time, result.rotor, result.omega_body, result.energy, result.position))
        yield from held(result.events)
    elif isinstance(result, ph.Moments):
        yield from held((result.count, result.mean))
    elif isinstance(result, ph.Stepper):
        yield from held(result.state)
    elif isinstance(result, dict):
        yield from (part for name, item in result.items() for part in (name, *held(item)))
    elif isinstance(result, list | tuple):
        yield from (part for item in result for part in held(item))
    elif dataclasses.is_dataclass(result):
        yield from (
            part for field in dataclasses.fields(result) for part in held(getattr(result, field.name))
        )
    elif isinstance(result, float):
        yield np.float64(result).tobytes()
    else:
        yield result
