"""Jacobians of the exponential maps: of rotation vectors to small turns, of screws to small displacements."""

from __future__ import annotations

from typing import Any

from polhode import _generic
from polhode._algebra.coefficients import as_coefficients, kind_of, require_real
from polhode._algebra.multivector import Multivector
from polhode._support.arrays import require_components
from polhode._support.calls import explains_calls


@explains_calls
def left_jacobian(v: Any, *, inverse: bool = False) -> Any:
    """Return the left Jacobian of the exponential map: J with ``R(v + dv) = R(J dv) R(v)``.

    R(v) is ``Rotor.from_rotation_vector(v)``. J maps rates of the rotation vector to the angular velocity in
    space, ``ω_S = J_l(v) v'``, and its inverse maps back:
    ``J = 1 + (1 − cos θ)/θ² [v]ₓ + (θ − sin θ)/θ³ [v]ₓ²`` (Chirikjian, Stochastic Models 2, eq. 10.86).

    Of exponential coordinates x of six components, as of `RigidTransform.as_exp_coords`, it is J with
    ``T(x + dx) = T(J dx) T(x)`` for ``T = RigidTransform.from_exp_coords``, and maps rates of x to twists in
    space.

    Parameters
    ----------
    v
        Rotation vectors (..., 3) of angle ``θ = |v|`` in radians; vectors; or planes, bivectors ``Bθ``, which
        have the same components. Or exponential coordinates (..., 6), a rotation vector and a velocity.
    inverse
        Whether to return the inverse. A ValueError at full turns, θ = 2π, 4π, …, where there is none.

    Returns
    -------
    Matrices (..., 3, 3) or (..., 6, 6), accurate to rounding for all angles; the inverse grows as
    1/|2π − θ|, in its lower left block as its square. Of NumPy floats, SymPy expressions or arrays of JAX,
    with derivatives at θ = 0, too.

    Examples
    --------
    A small change of a rotation vector, as a small turn after it:

    >>> R = ph.Rotor.from_rotation_vector
    >>> v, dv = np.array([0.3, 0.1, 0.2]), np.array([0, 1e-6, 0])
    >>> bool(R(v + dv).is_close(R(ph.left_jacobian(v) @ dv) * R(v), rtol=1e-11))
    True

    The same for a screw:

    >>> T, x, dx = ph.RigidTransform.exp, np.array([0.3, 0.1, 0.2, 1, 2, 3]), 1e-6 * np.ones(6)
    >>> bool(T(x + dx).is_close(T(ph.left_jacobian(x) @ dx) * T(x), rtol=1e-10))
    True
    """
    return _jacobian(v, 1, inverse)


@explains_calls
def right_jacobian(v: Any, *, inverse: bool = False) -> Any:
    """Return the right Jacobian of the exponential map: J with ``R(v + dv) = R(v) R(J dv)``.

    It maps rates of the rotation vector to the angular velocity in body axes, ``ω_B = J_r(v) v'``, and is
    the left one of −v, ``J_r(v) = J_l(−v)``; of a rotation vector it is the transpose of ``J_l(v)``. Of
    exponential coordinates, ``T(x + dx) = T(x) T(J dx)``: it maps rates of x to twists in body axes, and its
    inverse is the derivative of ``T.log()`` by a small displacement in body axes. Arguments and errors as
    in `left_jacobian`.

    Examples
    --------
    >>> v = [0.3, 0.1, 0.2]
    >>> bool(np.allclose(ph.right_jacobian(v), ph.left_jacobian(v).T))
    True
    """
    return _jacobian(v, -1, inverse)


def _jacobian(v: Any, sign: int, inverse: bool) -> Any:
    if isinstance(v, Multivector):
        if v.algebra.signature != (3, 0, 0) or v.grades not in ((1,), (2,)):
            raise TypeError(f"a rotation vector is a vector or a bivector of 3-d space, got {v!r}")
        given = v._data
        require_real(given, "a rotation vector")
    else:
        given = as_coefficients(v, "rotation vector")
    of_screws = not isinstance(v, Multivector) and tuple(given.shape[-1:]) == (6,)
    if not of_screws:
        require_components(given.shape, 3, "a rotation vector")
    kind = kind_of(given)
    left = _generic.jacobians.left_of_screws if of_screws else _generic.jacobians.left
    matrices = left(kind, sign * kind.asarray(given), inverse)
    return matrices.astype(given.dtype, copy=False) if kind.native else matrices
