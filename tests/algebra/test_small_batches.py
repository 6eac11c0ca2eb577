"""Single values, small batches and large ones have the same bits and errors."""

import numpy as np
import pytest

import polhode as ph

COUNT = 2000  # more numbers than a small batch has
ROWS = [0, 1, 777, COUNT - 1]
RNG = np.random.default_rng(11)
FOURS, TRIPLES, OTHERS = RNG.normal(size=(COUNT, 4)), RNG.normal(size=(COUNT, 3)), RNG.normal(size=(COUNT, 3))
TRIPLES[1] = [0, 0, 1e-200]
ANGLES = RNG.uniform(-7, 7, COUNT)
ROTORS, NEXT = ph.Rotor.from_components(FOURS), ph.Rotor.random(COUNT, RNG)

MAKERS = {
    "components": (ph.Rotor.from_components, FOURS),
    "wxyz": (lambda q: ph.Rotor.from_quaternion(q, order="wxyz"), FOURS),
    "xyzw": (lambda q: ph.Rotor.from_quaternion(q, order="xyzw"), FOURS),
    "rotation vector": (ph.Rotor.from_rotation_vector, TRIPLES),
    "vectors": (ph.Rotor.from_vectors, TRIPLES, OTHERS),
    "plane and angle": (ph.Rotor.from_plane_angle, TRIPLES, ANGLES),
    "axis and angle": (ph.Rotor.from_axis_angle, TRIPLES, ANGLES),
    "degrees": (lambda n, theta: ph.Rotor.from_axis_angle(n, theta, degrees=True), TRIPLES, ANGLES),
    "fixed axes": (lambda angles: ph.Rotor.from_euler("xyz", angles), TRIPLES),
    "axes of the body": (lambda angles: ph.Rotor.from_euler("ZX", angles, degrees=True), TRIPLES[:, :2]),
    "matrix": (ph.Rotor.from_matrix, ROTORS.to_matrix()),
}
READERS = {
    "matrix": (ph.Rotor.to_matrix, ROTORS),
    "wxyz": (lambda R: R.to_quaternion(order="wxyz"), ROTORS),
    "xyzw": (lambda R: R.to_quaternion(order="xyzw"), ROTORS),
    "rotation vector": (ph.Rotor.to_rotation_vector, ROTORS),
    "angle": (lambda R: R.angle, ROTORS),
    "fixed axes": (lambda R: R.to_euler("zyx"), ROTORS),
    "axes of the body": (lambda R: R.to_euler("ZXZ", degrees=True), ROTORS),
    "distance": (ph.Rotor.distance, ROTORS, NEXT),
    "squared norm": (ph.Multivector.norm_squared, ph.multivector(RNG.normal(size=(COUNT, 8)))),
    "norm": (ph.Multivector.norm, ph.vector(TRIPLES)),
    "squared norm of vectors": (ph.Multivector.norm_squared, ph.vector(TRIPLES)),
}
STEPS = {
    "canonical": (ph.Rotor.canonical, ROTORS),
    "power": (lambda R, n: R**n, ROTORS, ANGLES),
    "slerp": (ph.slerp, ROTORS, NEXT, np.linspace(0, 1, COUNT)),
    "normalized": (ph.Multivector.normalized, ph.vector(TRIPLES)),
    "inverse": (ph.Multivector.inverse, ph.vector(OTHERS)),
    "inverse of any": (ph.Multivector.inverse, ph.multivector(RNG.normal(size=(COUNT, 8)))),
    "exp": (ph.Multivector.exp, ph.multivector(RNG.normal(size=(COUNT, 8)))),
    "exp of bivectors": (ph.Multivector.exp, ph.bivector(TRIPLES)),
    "log": (ph.Multivector.log, ROTORS * 2.0),
    "sqrt": (ph.Multivector.sqrt, ROTORS * 2.0),
}


def assert_rows_equal(f, whole, given):
    """Compare some rows of the result for a large batch with single values and with small batches."""
    for part in (ROWS, *ROWS):
        found = np.asarray(f(*(x[part] for x in given)))
        np.testing.assert_array_equal(found.view(np.int64), np.ascontiguousarray(whole[part]).view(np.int64))


@pytest.mark.parametrize("kind", MAKERS)
def test_rotors_from_parameters(kind):
    f, *given = MAKERS[kind]
    whole = f(*given).components
    assert_rows_equal(lambda *x: f(*x).components, whole, given)
    strided = [np.repeat(x[ROWS], 2, axis=0)[::2] for x in given]
    np.testing.assert_array_equal(f(*strided).components, whole[ROWS])
    assert type(f(*(x[0].tolist() for x in given))) is ph.Rotor
    np.testing.assert_array_equal(f(*(x[0].tolist() for x in given)).components, whole[0])


@pytest.mark.parametrize("kind", MAKERS)
def test_rows_without_a_rotor_are_named(kind):
    f, *given = MAKERS[kind]
    bad = [np.array(x[:3]) for x in given]
    bad[0][2] = np.nan
    with pytest.raises(ValueError, match=r"\(2,\)"):
        f(*bad)
    with pytest.raises(ValueError, match=r"finite|NaN"):
        f(*(x[2] for x in bad))


@pytest.mark.parametrize("kind", READERS)
def test_parameters_of_rotors(kind):
    f, *given = READERS[kind]
    whole = f(*given)
    assert_rows_equal(f, whole, given)
    assert type(f(*(x[0] for x in given))) is type(whole[0])


@pytest.mark.parametrize("kind", STEPS)
def test_values_from_rotors(kind):
    f, *given = STEPS[kind]
    whole = f(*given)
    assert_rows_equal(lambda *x: f(*x).components, whole.components, given)
    assert type(f(*(x[0] for x in given))) is type(whole)


@pytest.mark.parametrize("shapes", [((3, 1), (2,)), ((), (4,)), ((2, 3), ()), ((0,), ())])
def test_batches_of_several_shapes(shapes):
    R, S = (ph.Rotor.random(shape, 3) for shape in shapes)
    whole = np.broadcast_shapes(*shapes)
    first, second = (ph.Rotor.from_components(np.broadcast_to(x.components, (*whole, 4))) for x in (R, S))
    np.testing.assert_array_equal(R.distance(S), first.distance(second))
    t = np.linspace(0, 1, np.prod(whole, dtype=int)).reshape(whole)
    np.testing.assert_array_equal(ph.slerp(R, S, t).components, ph.slerp(first, second, t).components)
    assert R.distance(S).shape == whole


def test_scalars_are_numbers_if_nothing_else_is_there():
    assert float(ph.e1 * ph.e1) == 1
    assert float((ph.e1 ^ ph.e2) * (ph.e2 ^ ph.e1)) == 1
    with pytest.raises(TypeError, match="only a single scalar converts to float"):
        float(1 + ph.e1)


@pytest.mark.parametrize("scale", [1e-300, 1.0, 1e300])
def test_single_values_are_close_as_batches_are(scale):
    a = ph.multivector(scale * RNG.normal(size=8))
    for change in (0.0, 1e-12, 1e-6, np.inf, np.nan):
        b = a + scale * change * ph.e2
        assert bool(a.is_close(b)) is bool(ph.stack([a]).is_close(ph.stack([b]))[0]) is (change < 1e-9)
    assert a.is_close(a + scale * ph.e1, atol=1.1 * scale)


def test_vectors_without_direction_are_refused():
    for bad in (ph.vector([0, 0, 0]), ph.vector([np.inf, 0, 0]), ph.vector([[1, 0, 0], [0, np.nan, 0]])):
        with pytest.raises(ValueError, match="has no direction"):
            bad.normalized()
    assert ph.vector([5e-324, 0, 0]).normalized() == ph.e1


def test_fields_of_packed_records_are_read_where_they_are():
    records = np.zeros(3, dtype=[("number", "i4"), ("q", "f8", (4,)), ("angle", "f8")])
    records["q"], records["angle"] = FOURS[:3], [0.1, 0.2, 0.3]
    R = ph.Rotor.from_components(records["q"])
    np.testing.assert_array_equal(R.components, ROTORS[:3].components)
    np.testing.assert_allclose(ph.Rotor.from_axis_angle(ph.e3, records["angle"]).angle, [0.1, 0.2, 0.3])
    np.testing.assert_array_equal((ph.e1 * records["angle"])["e1"], [0.1, 0.2, 0.3])
    np.testing.assert_array_equal(
        (R ** records["angle"]).components, (R ** np.array([0.1, 0.2, 0.3])).components
    )


@pytest.mark.parametrize("count", [2, COUNT])
def test_rotors_of_nan_are_refused(count):
    R = ph.Rotor.from_components(np.full((count, 4), np.nan), errors="mask")
    for f in (lambda R: R**2, lambda R: R.distance(R), lambda R: ph.slerp(R, R, 0.5)):
        for bad in (R, R[0]):
            with pytest.raises(ValueError, match="NaN"):
                f(bad)


def test_arguments_of_empty_batches_are_checked():
    with pytest.raises(ValueError, match="must be finite and not zero"):
        ph.Rotor.from_axis_angle([0, 0, 0], [])
    with pytest.raises(ValueError, match="must be finite"):
        ph.slerp(ph.Rotor.identity(), ph.Rotor.identity(0), np.nan)


def test_integers_beyond_floats_stay_exact():
    assert ph.Rotor.from_euler("x", 2**53 + 1).dtype == object
