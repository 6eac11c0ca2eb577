"""Calls of the public functions of the algebra with arrays of numbers, for tests over kinds of input."""

import inspect
from typing import Any, NamedTuple

import numpy as np

import polhode as ph


class Call(NamedTuple):
    """A function and float64 arrays that are valid for it; its result may be anything that holds numbers."""

    f: Any
    arrays: tuple[np.ndarray, ...]


_RNG = np.random.default_rng(7)
_BATCH = 4


def numbers(*shape):
    """Numbers of size 1, none of them near 0."""
    return _RNG.uniform(0.4, 1.6, shape) * _RNG.choice([-1.0, 1.0], shape)


def positive(*shape):
    return _RNG.uniform(0.5, 1.5, shape)


def turns(*shape):
    """Components of rotors of norm 1."""
    components = numbers(*shape, 4)
    return components / np.linalg.norm(components, axis=-1, keepdims=True)


V, B, M, R = numbers(_BATCH, 3), numbers(_BATCH, 3), numbers(_BATCH, 8), turns(_BATCH)
ANGLES, WEIGHTS, TIMES = positive(_BATCH), positive(_BATCH), np.array([0.0, 0.25, 0.5, 1.0])
_MATRICES, _POINTS = numbers(_BATCH, 3, 3), numbers(6, 3)
rotor = ph.Rotor.from_components


def _motor(t):
    return ph.RigidTransform(rotor(R), t)


def _value(owner, name, *arguments):
    """An attribute, or the result of a method."""
    found = getattr(owner, name)
    return found(*arguments) if inspect.isroutine(found) else found


def _unary(name):
    return Call(lambda m: getattr(ph.multivector(m), name)(), (M,))


def _binary(name):
    return Call(lambda a, b: getattr(ph.multivector(a), name)(ph.multivector(b)), (M, numbers(_BATCH, 8)))


def _of_vectors(name):
    return Call(lambda a, b: getattr(ph.vector(a), name)(ph.vector(b)), (V, B))


def _of_rotor(name, *arguments):
    return Call(lambda r: _value(rotor(r), name, *arguments), (R,))


def _of_map(name):
    return Call(lambda m: _value(ph.LinearMap.from_matrix(m), name), (_MATRICES,))


def _of_transform(name):
    return Call(lambda t: _value(_motor(t), name), (V,))


def _methods(kind, make, names):
    return {f"{kind}.{name}": make(name) for name in names.split()}


def _pga(f, *arrays):
    return Call(lambda *given: f(ph.pga(), *given), arrays)


def _cga(f, *arrays):
    return Call(lambda *given: f(ph.cga(), *given), arrays)


_ORIENTED = _MATRICES * np.sign(np.linalg.det(_MATRICES))[:, np.newaxis, np.newaxis]


def _even(components):
    """A motor from its components of the grades 0, 2 and 4."""
    full = ph.algebra(3, 0, 1).multivector(components)
    return full.grade(0) + full.grade(2) + full.grade(4)


CALLS = {
    **{
        name: Call(getattr(ph, name), (array,))
        for name, array in {
            "vector": V,
            "bivector": B,
            "trivector": V,
            "scalar": V,
            "multivector": M,
            "axial": B,
            "from_axial": V,
            "from_pauli": numbers(_BATCH, 2, 2),
            "left_jacobian": V,
            "right_jacobian": V,
            "longitude_latitude": V,
        }.items()
    },
    "axial": Call(lambda b: ph.axial(ph.bivector(b)), (B,)),
    "direction": Call(ph.direction, (ANGLES, WEIGHTS)),
    "cross": Call(lambda a, b: ph.cross(ph.vector(a), ph.vector(b)), (V, B)),
    "split": Call(lambda a, b: ph.split(ph.vector(a), ph.vector(b)), (V, B)),
    "stack": Call(lambda a, b: ph.stack([ph.vector(a), ph.vector(b)]), (V, B)),
    "concatenate": Call(lambda a, b: ph.concatenate([ph.vector(a), ph.bivector(b)]), (V, B)),
    "to_pauli": Call(lambda m: ph.to_pauli(ph.multivector(m)), (M,)),
    "to_dict": Call(lambda m: ph.to_dict(ph.multivector(m)), (M,)),
    "from_dict": Call(lambda m: ph.from_dict(ph.to_dict(ph.multivector(m))), (M,)),
    "reciprocal_frame": Call(lambda a: ph.reciprocal_frame([ph.e1, ph.e1 + ph.e2, ph.vector(a)]), (V,)),
    "align": Call(ph.align, (_POINTS, numbers(6, 3), positive(6))),
    "Alignment": Call(lambda a: ph.align(a, _POINTS).covariance, (numbers(6, 3),)),
    "mean": Call(lambda r, w: ph.mean(rotor(r), w), (R, WEIGHTS)),
    "slerp": Call(lambda a, b, t: ph.slerp(rotor(a), rotor(b), t), (R, turns(_BATCH), WEIGHTS)),
    "adjoint_matrix": Call(lambda t: ph.adjoint_matrix(_motor(t)), (V,)),
    "screw_parameters": Call(lambda t: ph.screw_parameters(_motor(t)), (V,)),
    "Screw": Call(lambda t: ph.screw_parameters(_motor(t)), (V,)),
    "Screw.moment": Call(lambda t: ph.screw_parameters(_motor(t)).moment, (V,)),
    "Screw.pitch": Call(lambda t: ph.screw_parameters(_motor(t)).pitch, (V,)),
    "attitude_from_rates": Call(lambda t, w: ph.attitude_from_rates(t, w), (TIMES, V)),
    "rates_from_attitude": Call(lambda t, r: ph.rates_from_attitude(t, rotor(r)), (TIMES, R)),
    "Algebra": Call(lambda a, b: ph.algebra(4, 1).multivector(a).exp() * b, (numbers(2, 32), numbers(2))),
    "Algebra.scalar": Call(lambda x: ph.algebra(4).scalar(x), (V,)),
    "Algebra.vector": Call(lambda x: ph.algebra(2, 1).vector(x), (V,)),
    "Algebra.bivector": Call(lambda x: ph.algebra(4).bivector(x), (numbers(_BATCH, 6),)),
    "Algebra.k_vector": Call(lambda x: ph.algebra(4).k_vector(3, x), (numbers(_BATCH, 4),)),
    "Algebra.pseudoscalar": Call(lambda x: ph.algebra(4).pseudoscalar(x), (V,)),
    "Algebra.multivector": Call(lambda x: ph.algebra(2).multivector(x), (numbers(_BATCH, 4),)),
    "Multivector": Call(
        lambda a, b: ph.multivector(a) * ph.multivector(b) + 2 - ph.vector(V) / 3, (M, numbers(_BATCH, 8))
    ),
    "Multivector.grade": Call(lambda m: ph.multivector(m).grade(0, 2), (M,)),
    **_methods(
        "Multivector",
        _binary,
        "geometric_product wedge dot commutator left_contraction right_contraction scalar_product "
        "anticommutator vee is_close",
    ),
    **_methods(
        "Multivector",
        _unary,
        "reverse inverse exp log sqrt conj sum mean dense grade_involution clifford_conjugate dual undual "
        "right_complement left_complement norm_squared norm normalized sin cos tan sinh cosh tanh outer_exp "
        "is_finite",
    ),
    **_methods(
        "Multivector",
        lambda name: Call(lambda m: str(getattr(ph.multivector(m), name)), (M,)),
        "shape dtype grades algebra components real imag",
    ),
    "Multivector.astype": Call(lambda m: ph.multivector(m).astype("f4"), (M,)),
    "Multivector.map": Call(lambda m: ph.multivector(m).map(np.round), (M,)),
    "Multivector.reshape": Call(lambda m: ph.multivector(m).reshape(-1, 2), (M,)),
    **_methods("Multivector", _of_vectors, "join project reject reflect"),
    "Multivector.meet": Call(lambda a, b: ph.bivector(a).meet(ph.bivector(b)), (V, B)),
    "Multivector.factor": Call(lambda b: ph.bivector(b).factor(), (B,)),
    "Rotor": Call(lambda r, x, n: (rotor(r)(ph.multivector(x)), rotor(r) ** n), (R, M, ANGLES)),
    "Rotor.exp": Call(lambda r: rotor(r).exp(), (R,)),
    "Rotor.apply": Call(lambda r, x: rotor(r).apply(ph.vector(x)), (R, V)),
    "Rotor.from_components": Call(rotor, (R,)),
    "Rotor.from_plane_angle": Call(ph.Rotor.from_plane_angle, (B, ANGLES)),
    "Rotor.from_vectors": Call(ph.Rotor.from_vectors, (V, B)),
    "Rotor.from_matrix": Call(lambda m: ph.Rotor.from_matrix(m, nearest=True), (_MATRICES,)),
    "Rotor.from_quaternion": Call(lambda q: ph.Rotor.from_quaternion(q, order="xyzw"), (R,)),
    "Rotor.from_rotation_vector": Call(ph.Rotor.from_rotation_vector, (V,)),
    "Rotor.from_euler": Call(lambda a: ph.Rotor.from_euler("ZYX", a), (V,)),
    "Rotor.from_axis_angle": Call(lambda v, a: ph.Rotor.from_axis_angle(ph.vector(v), a), (V, ANGLES)),
    "Rotor.from_mrp": Call(ph.Rotor.from_mrp, (V,)),
    "Rotor.from_davenport": Call(
        lambda axes, a: ph.Rotor.from_davenport(axes, "extrinsic", a), (np.eye(3), V)
    ),
    "Rotor.from_multivector": Call(
        lambda r: ph.Rotor.from_multivector(rotor(R) + ph.bivector(r) * 1e-3), (B,)
    ),
    **_methods(
        "Rotor",
        _of_rotor,
        "angle magnitude log to_mrp to_matrix to_rotation_vector plane_angle canonical continuous inverse "
        "sqrt normalized grade_involution",
    ),
    "Rotor.to_davenport": _of_rotor("to_davenport", np.eye(3), "extrinsic"),
    "Rotor.to_quaternion": Call(lambda r: rotor(r).to_quaternion(order="wxyz"), (R,)),
    "Rotor.to_euler": _of_rotor("to_euler", "xyz"),
    "Rotor.distance": Call(lambda r, s: rotor(r).distance(rotor(s)), (R, turns(_BATCH))),
    "Rotor.astype": _of_rotor("astype", np.float32),
    "Rotor.reduce": Call(lambda r: rotor(r).reduce(left=ph.Rotor.group("O")), (R,)),
    "RotorSpline": Call(lambda t, r, s: ph.RotorSpline(t, rotor(r))(s), (TIMES, R, TIMES * 0.9)),
    "RotorSpline.times": Call(lambda t: ph.RotorSpline(t, rotor(R)).times, (TIMES,)),
    "RotorSpline.rotors": Call(lambda r: ph.RotorSpline(TIMES, rotor(r)).rotors, (R,)),
    "RotorSpline.omega_body": Call(lambda t: ph.RotorSpline(TIMES, rotor(R)).omega_body(t), (TIMES * 0.9,)),
    "RotorSpline.alpha_body": Call(lambda t: ph.RotorSpline(TIMES, rotor(R)).alpha_body(t), (TIMES * 0.9,)),
    "LinearMap": Call(lambda m, x: ph.LinearMap.from_matrix(m)(ph.multivector(x)), (_MATRICES, M)),
    "LinearMap.from_matrix": Call(ph.LinearMap.from_matrix, (_MATRICES,)),
    "LinearMap.from_function": Call(
        lambda a: ph.LinearMap.from_function(lambda x: x + (x | ph.vector(a)) * ph.e1), (V[0],)
    ),
    "LinearMap.is_close": Call(
        lambda m, n: ph.LinearMap.from_matrix(m).is_close(ph.LinearMap.from_matrix(n)), (_MATRICES, _MATRICES)
    ),
    **_methods(
        "LinearMap",
        _of_map,
        "matrix shape grade bivector_matrix outermorphism_matrix determinant trace adjoint inverse "
        "symmetric_part antisymmetric_part svd",
    ),
    "LinearMap.polar": Call(lambda m: ph.LinearMap.from_matrix(m).polar(), (_ORIENTED,)),
    "LinearMap.algebra": Call(lambda m: str(ph.LinearMap.from_matrix(m).algebra), (_MATRICES,)),
    **_methods(
        "LinearMap",
        lambda name: Call(
            lambda m: getattr(ph.LinearMap.from_matrix(m).symmetric_part(), name)(), (_MATRICES,)
        ),
        "eigenvectors eigenplanes",
    ),
    "RigidTransform": Call(lambda r, t: ph.RigidTransform(rotor(r), t) * _motor(V), (R, V)),
    "RigidTransform.from_rotation": Call(lambda r: ph.RigidTransform.from_rotation(rotor(r)), (R,)),
    "RigidTransform.from_translation": Call(ph.RigidTransform.from_translation, (V,)),
    "RigidTransform.from_components": Call(lambda t: ph.RigidTransform.from_components(t, rotor(R)), (V,)),
    "RigidTransform.from_matrix": Call(lambda m: ph.RigidTransform.from_matrix(m), (_motor(V).as_matrix(),)),
    "RigidTransform.from_exp_coords": Call(ph.RigidTransform.from_exp_coords, (numbers(_BATCH, 6),)),
    "RigidTransform.from_screw": Call(ph.RigidTransform.from_screw, (V, B, WEIGHTS, WEIGHTS)),
    "RigidTransform.exp": Call(ph.RigidTransform.exp, (numbers(_BATCH, 6),)),
    "RigidTransform.from_dual_quat": Call(ph.RigidTransform.from_dual_quat, (_motor(V).as_dual_quat(),)),
    "RigidTransform.from_motor": Call(
        lambda m: ph.RigidTransform.from_motor(_even(m)), (_motor(V).to_motor().dense(),)
    ),
    "RigidTransform.concatenate": Call(
        lambda t, u: ph.RigidTransform.concatenate([_motor(t), _motor(u)]), (V, B)
    ),
    "RigidTransform.stack": Call(lambda t, u: ph.RigidTransform.stack([_motor(t), _motor(u)]), (V, B)),
    "RigidTransform.apply": Call(lambda t, x: _motor(t).apply(x), (V, B)),
    "RigidTransform.interpolate": Call(lambda t, s: _motor(t).interpolate(_motor(B), s), (V, WEIGHTS)),
    "RigidTransform.mean": Call(lambda t, w: _motor(t).mean(w), (V, WEIGHTS)),
    "RigidTransform.is_close": Call(lambda t, u: _motor(t).is_close(_motor(u)), (V, V)),
    **_methods(
        "RigidTransform",
        _of_transform,
        "rotation rotor translation as_components as_matrix to_matrix as_exp_coords log as_dual_quat "
        "to_motor screw_parameters adjoint inv inverse shape single",
    ),
    "PGA": _pga(lambda A, x, y: A.point(x) & A.point(y), V, B),
    "PGA.point": _pga(lambda A, x: A.point(x), V),
    "PGA.direction": _pga(lambda A, x: A.direction(x), V),
    "PGA.plane": _pga(lambda A, n, d: A.plane(n, d), V, ANGLES),
    "PGA.line": _pga(lambda A, x, y: A.line(x, y), V, B),
    "PGA.coordinates": _pga(lambda A, x: A.coordinates(A.point(x)), V),
    "PGA.down": _pga(lambda A, x: A.down(A.point(x)), V),
    "PGA.normal_and_distance": _pga(lambda A, n: A.normal_and_distance(A.plane(n, 2)), V),
    "PGA.point_and_direction": _pga(lambda A, x: A.point_and_direction(A.line(x, direction=B)), V),
    "PGA.normalized": _pga(lambda A, x: A.normalized(2 * A.point(x)), V),
    "PGA.translator": _pga(lambda A, x: A.translator(x), V),
    "PGA.motor": _pga(lambda A, r, x: A.motor(rotor(r), x), R, V),
    "PGA.transform": _pga(lambda A, x: A.transform(A.motor(rotor(R), x)), V),
    "PGA.embed": _pga(lambda A, m: A.embed(ph.multivector(m)), M),
    "PGA.null_last": _pga(lambda A, x: A.null_last(A.point(x)), V),
    "CGA": _cga(lambda A, x, y: A.up(x) | A.up(y), V, B),
    "CGA.up": _cga(lambda A, x: A.up(x), V),
    "CGA.point": _cga(lambda A, x: A.point(x), V),
    "CGA.down": _cga(lambda A, x: A.down(A.up(x)), V),
    "CGA.coordinates": _cga(lambda A, x: A.coordinates(A.up(x)), V),
    "CGA.line": _cga(lambda A, x, y: A.line(x, y), V, B),
    "CGA.plane": _cga(lambda A, n, d: A.plane(n, d), V, ANGLES),
    "CGA.point_pair": _cga(lambda A, x, y: A.point_pair(x, y), V, B),
    "CGA.circle": _cga(lambda A, x, n, r: A.circle(x, n, r), V, B, ANGLES),
    "CGA.sphere": _cga(lambda A, x, r: A.sphere(x, r), V, ANGLES),
    "CGA.center": _cga(lambda A, x: A.center(A.sphere(x, 0.5)), V),
    "CGA.squared_radius": _cga(lambda A, r: A.squared_radius(A.sphere(V, r)), ANGLES),
    "CGA.radius": _cga(lambda A, r: A.radius(A.circle(V, B, r)), ANGLES),
    "CGA.points": _cga(lambda A, x, y: A.points(A.point_pair(x, y)), V, B),
    "CGA.point_and_direction": _cga(lambda A, x, y: A.point_and_direction(A.line(x, y)), V, B),
    "CGA.normal_and_distance": _cga(lambda A, n: A.normal_and_distance(A.plane(n, 2)), V),
    "CGA.rotor": _cga(lambda A, r: A.rotor(rotor(r)), R),
    "CGA.translator": _cga(lambda A, x: A.translator(x), V),
    "CGA.dilator": _cga(lambda A, s, x: A.dilator(s, x), ANGLES, V),
    "CGA.motor": _cga(lambda A, r, x: A.motor(rotor(r), x), R, V),
    "CGA.embed": _cga(lambda A, m: A.embed(ph.multivector(m)), M),
    "Formula": Call(lambda a, b: ph.formula("a b + exp(a ∧ b)")(a=ph.vector(a), b=ph.vector(b)), (V, B)),
    "formula": Call(lambda a, b: ph.formula("2 a b")(a=a, b=ph.vector(b)), (ANGLES, B)),
    "evaluate": Call(lambda a, b: ph.evaluate("a·b / norm(a)", a=ph.vector(a), b=ph.vector(b)), (V, B)),
    "Agreement": Call(
        lambda a, b: ph.evaluate("a b = a·b + a∧b", a=ph.vector(a), b=ph.vector(b)).residual, (V, B)
    ),
}
# No arrays of numbers among the arguments, or none but those of a value that another call makes.
WITHOUT_NUMBERS = """
    algebra cga pga FormulaError Formula.text Formula.arguments Formula.ascii Formula.latex
    Formula.spelled Formula.tree Formula.grades Formula.steps Formula.code Formula.grad
    Alignment.rotor Alignment.residual Alignment.covariance Screw.axis Screw.point Screw.angle Screw.distance
    Agreement.holds Agreement.within Agreement.residual Agreement.size Agreement.rtol
    CGA.eo CGA.einf PGA.e0 Algebra.signature Algebra.dimension Algebra.size Algebra.basis_vectors
    Algebra.blades Algebra.I Algebra.random Rotor.identity Rotor.random Rotor.group LinearMap.identity
    RigidTransform.identity RigidTransform.from_scipy RigidTransform.to_scipy
    Rotor.from_scipy Rotor.to_scipy Rotor.from_numpy_quaternion Rotor.to_numpy_quaternion
    Multivector.diff Multivector.subs Multivector.simplify
"""
