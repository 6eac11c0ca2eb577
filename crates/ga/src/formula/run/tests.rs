//! Programs by blocks against single values, and both against the calls made one by one.

use crate::formula::compile::program::{Id, Input, InputKind, Op, Program, Step};
use crate::formula::{Given, Number, RowError, Runner, Span, Type};
use crate::g3::functions::Function;
use crate::product::{Grades, Plan, Product};
use crate::rows::{compose, product, rotor_functions};
use crate::simd::Path;
use crate::simd::lanes::PerLane;
use crate::simd::short::{GROUP, Source};
use crate::simd::threads::Threads;
use crate::simd::traverse::Factor;
use crate::table::{G3, Signature};
use crate::{Graded, MathError, Multivector, Rotor};

const VECTOR: Grades = Grades(0b0010);

/// Numbers between −1 and 1, from a linear congruence.
struct Random(u64);

impl Random {
    fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn below(&mut self, count: usize) -> usize {
        ((self.number() + 1.0) / 2.0 * count as f64) as usize % count
    }

    /// So many rows of an input; a rotor's are of norm 1.
    fn rows(&mut self, kind: InputKind, count: usize) -> Vec<f64> {
        let mut row = || match kind {
            InputKind::Value(ty) if ty.unit => {
                Rotor::from_components([0; 4].map(|_| self.number())).unwrap().components().to_vec()
            }
            InputKind::Value(ty) => ty.grades.indices(&G3).iter().map(|_| self.number()).collect(),
            InputKind::Matrix { .. } => (0..9).map(|_| self.number()).collect(),
            InputKind::Determinant => vec![self.number()],
        };
        (0..count).flat_map(|_| row()).collect()
    }
}

fn step(op: Op, ty: Type) -> Step {
    Step { op, ty, span: Span::default() }
}

fn program(inputs: &[InputKind], steps: Vec<Step>, results: Vec<Id>) -> Program {
    let input = |(i, &kind): (usize, &InputKind)| Input { name: format!("x{i}"), kind };
    let inputs = inputs.iter().enumerate().map(input).collect();
    Program { signature: Signature { p: 3, q: 0, r: 0 }, inputs, steps, results: vec![results] }
}

/// Steps on random earlier ones, of which some are rotors, scalars, vectors and bivectors from the start.
fn random_program(random: &mut Random) -> Program {
    let some = Grades(1 + random.below(15) as u16);
    let types = [Type::ROTOR, Type::SCALAR, Type::of(VECTOR), Type::of(Grades::BIVECTOR), Type::of(some)];
    let mut inputs: Vec<InputKind> = types.map(InputKind::Value).to_vec();
    inputs.extend([InputKind::Matrix { grade: 1 }, InputKind::Determinant]);
    let mut steps: Vec<Step> = types.iter().enumerate().map(|(i, &ty)| step(Op::Input(i), ty)).collect();
    steps.push(step(Op::Constant(Number::float(0.3), 2), Type::of(VECTOR)));
    steps.push(step(Op::Pi, Type::SCALAR));
    for _ in 0..4 + random.below(20) {
        let (a, b) = (random.below(steps.len()), random.below(steps.len()));
        let (ga, gb) = (steps[a].ty.grades, steps[b].ty.grades);
        let part = Grades(1 + random.below(15) as u16);
        let plan = Product::ALL[random.below(7)];
        // The latest step of some grades, or of norm 1.
        let latest = |fits: &dyn Fn(Type) -> bool| steps.iter().rposition(|s| fits(s.ty)).unwrap();
        let rotor = latest(&|ty| ty.unit);
        let [scalar, vector, bivector] =
            [Grades::SCALAR, VECTOR, Grades::BIVECTOR].map(|g| latest(&|ty| ty.grades == g));
        steps.push(match random.below(21) {
            0 => step(Op::Add(a, b), Type::of(Grades(ga.0 | gb.0))),
            1 => step(Op::Subtract(a, b), Type::of(Grades(ga.0 | gb.0))),
            2 => step(Op::Negate(a), steps[a].ty),
            3 | 4 => step(Op::Product(plan, a, b), Type::of(Plan::g3(plan, ga, gb).grades)),
            5 => step(Op::Product(plan, a, b), Type::of(part)),
            6 => step(Op::Compose(rotor, 0), Type::ROTOR),
            7 | 8 => step(Op::Turn(rotor, a), steps[a].ty),
            9 => step(Op::Divide(a, scalar), Type::of(ga)),
            10 => step(Op::Reverse(a), steps[a].ty),
            11 => step(Op::Part(a), Type::of(part)),
            k @ (12 | 13) => {
                let dual = Grades((0..4).map(|k| (1 << (3 - k)) * u16::from(ga.contains(k))).sum());
                step(if k == 12 { Op::Dual(a) } else { Op::Undual(a) }, Type::of(dual))
            }
            14 => step(Op::Function(Function::Exp, bivector), Type::ROTOR),
            15 => step(Op::Function(Function::Log, rotor), Type::of(Grades::BIVECTOR)),
            16 => step(Op::RotorPower(rotor, random.below(9) as i32 - 4), Type::ROTOR),
            17 => step(Op::Norm(a), Type::SCALAR),
            18 => step([Op::Sin(scalar), Op::Cos(scalar), Op::Tan(scalar)][random.below(3)], Type::SCALAR),
            19 => step(Op::Map { input: 5, argument: vector }, Type::of(VECTOR)),
            _ => {
                let f = Function::ALL[random.below(4)];
                let of = latest(&|ty| !ty.unit && ty.grades != Grades::BIVECTOR);
                step(Op::Function(f, of), Type::of(f.grades(steps[of].ty.grades)))
            }
        });
    }
    let last = steps.len() - 1;
    let results = vec![last, random.below(last), 2];
    program(&inputs, steps, results)
}

/// Equal bit for bit; any NaN equals any other.
fn assert_same(got: &[f64], expected: &[f64], what: &str) {
    assert_eq!(got.len(), expected.len(), "{what}");
    for (i, (x, y)) in got.iter().zip(expected).enumerate() {
        assert!(x.to_bits() == y.to_bits() || x.is_nan() && y.is_nan(), "{what}, number {i}: {x} {y}");
    }
}

/// What single values give: the results row by row up to the first row that has none.
fn one_by_one(
    program: &Program,
    runner: &Runner,
    data: &[Vec<f64>],
    rows: usize,
) -> Result<Vec<Vec<f64>>, RowError> {
    let mut results = vec![Vec::new(); program.results[0].len()];
    for row in 0..rows {
        let inputs: Vec<Given> = program
            .inputs
            .iter()
            .zip(data)
            .map(|(input, data)| {
                let size = input.kind.size();
                let row = if data.len() == size { 0 } else { row };
                Given::new(input.kind, |k| data[row * size + k])
            })
            .collect();
        let values = runner.value(&inputs).map_err(|(step, error)| RowError { row, step, error })?;
        results
            .iter_mut()
            .zip(&program.results[0])
            .for_each(|(out, &id)| out.extend(values[id].components()));
    }
    Ok(results)
}

/// Random programs, some inputs of one row: every path and any number of threads, all rows or some at a time,
/// give the bits of single values, or the same error.
#[test]
fn blocks_equal_single_values() {
    let mut random = Random(7);
    let mut failures = 0;
    for round in 0..150 {
        let program = random_program(&mut random);
        let runner = Runner::new(&program).unwrap();
        let rows = [1, 5, 8, 63, 64, 65, 150][round % 7];
        let fixed = random.below(128);
        let data: Vec<Vec<f64>> = program
            .inputs
            .iter()
            .enumerate()
            .map(|(i, input)| random.rows(input.kind, if fixed >> i & 1 == 1 { 1 } else { rows }))
            .collect();
        let expected = one_by_one(&program, &runner, &data, rows);
        failures += usize::from(expected.is_err());
        let inputs: Vec<&[f64]> = data.iter().map(Vec::as_slice).collect();
        for path in Path::available() {
            for (threads, cut) in [(1, rows), (3, rows), (1, rows / 2)] {
                let mut out: Vec<Vec<f64>> = program.results[0]
                    .iter()
                    .map(|&id| vec![0.5; rows * program.steps[id].ty.grades.indices(&G3).len()])
                    .collect();
                let mut outputs: Vec<&mut [f64]> = out.iter_mut().map(Vec::as_mut_slice).collect();
                let got = [0..cut, cut..rows].into_iter().try_for_each(|rows| {
                    runner.run_on(path, Threads::new(threads), &inputs, &mut outputs, rows)
                });
                let what = format!("{path:?} {rows} rows {program:?}");
                match &expected {
                    Ok(expected) => {
                        assert_eq!(got, Ok(()), "{what}");
                        out.iter().zip(expected).for_each(|(x, y)| assert_same(x, y, &what));
                    }
                    Err(error) => assert_eq!(got.as_ref(), Err(error), "{what}"),
                }
            }
        }
    }
    assert!((5..100).contains(&failures), "{failures} programs have no value");
}

/// Steps on random earlier ones, all of which have a function of short rows.
fn random_short_program(random: &mut Random) -> Program {
    let bivector = Type::of(Grades::BIVECTOR);
    let types = [Type::ROTOR, Type::SCALAR, Type::of(VECTOR), bivector, Type::of(Grades::EVEN)];
    let mut steps: Vec<Step> = types.iter().enumerate().map(|(i, &ty)| step(Op::Input(i), ty)).collect();
    for _ in 0..1 + random.below(12) {
        let (a, b) = (random.below(steps.len()), random.below(steps.len()));
        let (ga, gb) = (steps[a].ty.grades, steps[b].ty.grades);
        let rotor = steps.iter().rposition(|s| s.ty.unit).unwrap();
        let three =
            steps.iter().rposition(|s| s.ty.grades == VECTOR || s.ty.grades == Grades::BIVECTOR).unwrap();
        let product = Product::ALL[random.below(7)];
        let plan = Plan::g3(product, ga, gb);
        steps.push(match random.below(8) {
            0 if ga == gb => step(Op::Add(a, b), Type::of(ga)),
            1 if ga == gb => step(Op::Subtract(a, b), Type::of(ga)),
            2 => step(Op::Negate(a), Type::of(ga)),
            3 => step(Op::Compose(rotor, 0), Type::ROTOR),
            4 => step(Op::Reverse(rotor), Type::ROTOR),
            5 | 6 if plan.fixed_terms.is_some() => step(Op::Product(product, a, b), Type::of(plan.grades)),
            _ => step(Op::Turn(rotor, three), steps[three].ty),
        });
    }
    let last = steps.len() - 1;
    program(&types.map(InputKind::Value), steps, vec![last])
}

/// Programs of short steps as chains, some inputs of one row: on every path, with rows left over and only some rows, the bits
/// of single values.
#[test]
fn chains_equal_single_values() {
    let mut random = Random(5);
    for round in 0..120 {
        let program = random_short_program(&mut random);
        let runner = Runner::new(&program).unwrap();
        let rows = [15, 16, 17, 40, 150][round % 5];
        let fixed = if round % 3 == 0 { random.below(32) } else { 0 };
        let count = |i: usize| if fixed >> i & 1 == 1 { 1 } else { rows };
        let inputs = program.inputs.iter().enumerate();
        let data: Vec<Vec<f64>> = inputs.map(|(i, input)| random.rows(input.kind, count(i))).collect();
        let expected = one_by_one(&program, &runner, &data, rows).unwrap().remove(0);
        let given: Vec<&[f64]> = data.iter().map(Vec::as_slice).collect();
        let sizes = program.inputs.iter().map(|input| input.kind.size());
        let factors: Vec<_> = given.iter().zip(sizes).map(|(x, size)| Factor::new(x, size, rows)).collect();
        let schedule = runner.schedule(&[None; 5], false, &runner.whole()).unwrap();
        for path in Path::available() {
            let input = |i: usize| (Source::Rows(factors[i].all()), factors[i].size());
            let chain = runner.chain::<_, GROUP>(path, &schedule, input);
            assert_eq!(chain.is_some(), path.has_short_blocks());
            let mut out = vec![0.5; expected.len()];
            for part in [0..rows / 3, rows / 3..rows] {
                runner.run_on(path, Threads::ONE, &given, &mut [&mut out], part).unwrap();
            }
            assert_same(&out, &expected, &format!("{path:?} {rows} rows {program:?}"));
        }
    }
}

/// A chain past the caches, by several threads, from and to any place in a cache line, with rows left over.
#[test]
fn streamed_chains_equal_products() {
    let mut random = Random(6);
    let steps = vec![
        step(Op::Input(0), Type::ROTOR),
        step(Op::Input(1), Type::of(VECTOR)),
        step(Op::Turn(0, 1), Type::of(VECTOR)),
    ];
    let kinds = [Type::ROTOR, Type::of(VECTOR)].map(InputKind::Value);
    let runner = Runner::new(&program(&kinds, steps, vec![2])).unwrap();
    let most = super::STREAMED / 8 / 10 + 24;
    let [r, v] = kinds.map(|kind| random.rows(kind, most + 2));
    for (number, rows) in (most - 17..most).enumerate() {
        let (r, v) = (&r[number % 4..][..4 * rows], &v[number % 3..][..3 * rows]);
        let mut expected = vec![0.0; 3 * rows];
        product::turn(Threads::ONE, r, v, VECTOR, &mut expected);
        for path in Path::available() {
            let mut out = vec![0.5; 3 * rows + 8];
            let threads = Threads::new(1 + number % 3);
            runner
                .run_on(path, threads, &[r, v], &mut [&mut out[number % 8..][..3 * rows]], 0..rows)
                .unwrap();
            assert_same(&out[number % 8..][..3 * rows], &expected, &format!("{path:?} {rows} rows"));
            assert_eq!(out[3 * rows + number % 8..], [0.5; 8][number % 8..], "numbers after the result");
        }
    }
}

/// Random programs on lanes, filled twice, some inputs the same for all, one of them a parameter that is sometimes
/// announced: the bits of single values, and NaN for the rows that have none.
#[test]
fn lanes_equal_single_values() {
    let failures = lanes_against_single_values::<8>() + lanes_against_single_values::<16>();
    assert!((50..3000).contains(&failures), "{failures} rows have no value");
}

/// How many rows have no value.
fn lanes_against_single_values<const ROWS: usize>() -> usize {
    let mut random = Random(11);
    let mut failures = 0;
    for round in 0..200 {
        let short = round % 4 == 0;
        let program = if short { random_short_program(&mut random) } else { random_program(&mut random) };
        let runner = Runner::new(&program).unwrap();
        let fixed = random.below(128);
        let is_known = |i: usize| fixed >> i & 1 == 1;
        let draw = |random: &mut Random| -> Vec<Vec<f64>> {
            program.inputs.iter().map(|input| random.rows(input.kind, ROWS)).collect()
        };
        let first = draw(&mut random);
        let row = |data: &[Vec<f64>], i: usize, row: usize| {
            let (kind, size) = (program.inputs[i].kind, program.inputs[i].kind.size());
            Given::new(kind, |k| if is_known(i) { first[i][k] } else { data[i][row * size + k] })
        };
        let known: Vec<Option<Given>> =
            (0..program.inputs.len()).map(|i| is_known(i).then(|| row(&first, i, 0))).collect();
        let always = runner.fixed(&known.iter().map(Option::is_some).collect::<Vec<_>>());
        let is_number = |i: &usize| !is_known(*i) && program.inputs[*i].kind.size() == 1;
        let numbers: Vec<usize> = (0..program.inputs.len()).filter(is_number).collect();
        let parameter = (!numbers.is_empty()).then(|| numbers[random.below(numbers.len())]);
        let mut beside = runner.side_by_side::<ROWS>(&known, parameter);
        let mut second = draw(&mut random);
        if let Some(parameter) = parameter {
            let shared = second[parameter][0];
            second[parameter].fill(shared);
        }
        for (data, announced) in
            [(&first, false), (&second, false), (&first, true), (&second, true), (&second, false)]
        {
            if let Some(beside) = &mut beside {
                if let Some(parameter) = parameter {
                    if announced {
                        beside.foresee([0.5, 0.5, data[parameter][0], 0.25].into_iter());
                    }
                    let numbers: &[f64; ROWS] = data[parameter].as_slice().try_into().unwrap();
                    let common = announced && *numbers == [numbers[0]; ROWS];
                    let numbers = if common { PerLane::Common(numbers[0]) } else { PerLane::Each(*numbers) };
                    beside.set_parameter(parameter, &numbers);
                }
                for i in (0..program.inputs.len()).filter(|&i| !is_known(i) && Some(i) != parameter) {
                    let lanes = beside.input(i);
                    let size = lanes.len();
                    for (n, x) in data[i].iter().enumerate() {
                        lanes[n % size].0[n / size] = *x;
                    }
                }
                beside.run();
            }
            for l in 0..ROWS {
                let inputs: Vec<Given> = (0..program.inputs.len()).map(|i| row(data, i, l)).collect();
                let values = runner.value(&inputs);
                failures += usize::from(values.is_err());
                let Some(beside) = &beside else {
                    assert!(values.is_err(), "{program:?}");
                    continue;
                };
                for (number, &id) in program.results[0].iter().enumerate() {
                    let got: Vec<f64> = beside.result(number).iter().map(|lane| lane.0[l]).collect();
                    match &values {
                        Ok(values) => assert_same(&got, values[id].components(), &format!("{program:?}")),
                        Err(_) => assert!(always[id] || got.iter().all(|x| x.is_nan()), "{program:?}"),
                    }
                }
            }
        }
    }
    failures
}

/// Each step alone has the bits of the call by hand, on single values and on batches.
#[test]
fn steps_equal_calls_by_hand() {
    let mut random = Random(1);
    let rows = 70;
    let some = Grades(0b0110);
    let types = [
        Type::ROTOR,
        Type::ROTOR,
        Type::of(some),
        Type::of(Grades::BIVECTOR),
        Type::of(VECTOR),
        Type::SCALAR,
    ];
    let kinds = types.map(InputKind::Value);
    let data = kinds.map(|kind| random.rows(kind, rows));
    let [r, s, x, b, v, t] = data.each_ref().map(Vec::as_slice);
    let run = |op: Op, ty: Type| {
        let mut steps: Vec<Step> = types.iter().enumerate().map(|(i, &ty)| step(Op::Input(i), ty)).collect();
        steps.push(step(op, ty));
        let program = program(&kinds, steps, vec![6]);
        let mut out = vec![0.5; rows * ty.grades.indices(&G3).len()];
        Runner::new(&program)
            .unwrap()
            .run(Threads::ONE, &[r, s, x, b, v, t], &mut [&mut out], 0..rows)
            .unwrap();
        out
    };
    let by_value = |grades: Grades, data: &[f64], f: &dyn Fn(usize, &Graded) -> Graded| -> Vec<f64> {
        let size = grades.indices(&G3).len();
        let rows = data.chunks(size).map(|c| Graded::new(c, grades).unwrap()).enumerate();
        rows.flat_map(|(i, x)| f(i, &x).components().to_vec()).collect()
    };
    let unit = |i: usize| Rotor::from_unit_components(std::array::from_fn(|k| r[4 * i + k]));
    let mut expected = vec![0.0; 4 * rows];
    compose::compose(Threads::ONE, r, s, &mut expected);
    assert_same(&run(Op::Compose(0, 1), Type::ROTOR), &expected, "compose");
    rotor_functions::exp(Threads::ONE, b, &mut expected).unwrap();
    assert_same(&run(Op::Function(Function::Exp, 3), Type::ROTOR), &expected, "exp");
    rotor_functions::power(Threads::ONE, r, &[-3.0], &mut expected).unwrap();
    assert_same(&run(Op::RotorPower(0, -3), Type::ROTOR), &expected, "power");
    let mut expected = vec![0.0; 3 * rows];
    rotor_functions::log(Threads::ONE, r, &mut expected).unwrap();
    assert_same(&run(Op::Function(Function::Log, 0), Type::of(Grades::BIVECTOR)), &expected, "log");
    let mut expected = vec![0.0; 6 * rows];
    product::turn(Threads::ONE, r, x, some, &mut expected);
    assert_same(&run(Op::Turn(0, 2), Type::of(some)), &expected, "turn");
    let turned = by_value(some, x, &|i, x| x.turned(unit(i)));
    assert_same(&expected, &turned, "turned");
    for product in Product::ALL {
        let plan = Plan::g3(product, some, VECTOR);
        let mut expected = vec![0.0; plan.sizes.2 * rows];
        plan.run(Threads::ONE, x, v, &mut expected);
        assert_same(&run(Op::Product(product, 2, 4), Type::of(plan.grades)), &expected, "product");
        let vector = |i: usize| Graded::new(&v[3 * i..3 * i + 3], VECTOR).unwrap();
        let part = by_value(some, x, &|i, x| x.product(product, &vector(i)).with_grades(Grades(0b0101)));
        assert_same(&run(Op::Product(product, 2, 4), Type::of(Grades(0b0101))), &part, "part of a product");
    }
    let scalar = |i: usize| Graded::new(&t[i..i + 1], Grades::SCALAR).unwrap();
    let sum = by_value(some, x, &|i, x| x.zip(&scalar(i), |x, y| x - y));
    assert_same(&run(Op::Subtract(2, 5), Type::of(Grades(0b0111))), &sum, "difference");
    let inverse_of_i = Graded::new(&[-1.0], Grades(0b1000)).unwrap();
    let dual = by_value(some, x, &|_, x| x.product(Product::Geometric, &inverse_of_i));
    assert_same(&run(Op::Dual(2), Type::of(some)), &dual, "dual");
    let undual = by_value(some, x, &|_, x| x.product(Product::Geometric, &inverse_of_i.map(|x| -x)));
    assert_same(&run(Op::Undual(2), Type::of(some)), &undual, "undual");
    assert_same(&run(Op::Reverse(2), Type::of(some)), &by_value(some, x, &|_, x| x.reverse()), "reverse");
    let norm =
        by_value(some, x, &|_, x| Graded::new(&[Multivector(x.full()).norm()], Grades::SCALAR).unwrap());
    assert_same(&run(Op::Norm(2), Type::SCALAR), &norm, "norm");
    let quotient = by_value(some, x, &|i, x| x.map(|x| x / t[i]));
    assert_same(&run(Op::Divide(2, 5), Type::of(some)), &quotient, "quotient");
    // Within an ulp of the library's, which is within one itself.
    let circular = [(Op::Sin(5), f64::sin as fn(f64) -> f64), (Op::Cos(5), f64::cos), (Op::Tan(5), f64::tan)];
    for (op, library) in circular {
        for (got, x) in run(op, Type::SCALAR).iter().zip(t) {
            assert!((got - library(*x)).abs() <= 3.0 * f64::EPSILON * library(*x).abs(), "{got} of {x}");
        }
    }
}

/// The first row that fails is found, and the first step that fails there, among many failures.
#[test]
fn the_first_failure_is_reported() {
    let kinds = [Type::SCALAR, Type::of(Grades::BIVECTOR)].map(InputKind::Value);
    let steps = vec![
        step(Op::Input(0), Type::SCALAR),
        step(Op::Input(1), Type::of(Grades::BIVECTOR)),
        step(Op::Function(Function::Exp, 1), Type::ROTOR),
        step(Op::Divide(2, 0), Type::of(Grades::EVEN)),
    ];
    let runner = Runner::new(&program(&kinds, steps, vec![3])).unwrap();
    let rows = 200_000;
    let run = |zeros: &[usize], infinite: &[usize], threads| {
        let (mut s, mut b) = (vec![1.0; rows], vec![0.5; 3 * rows]);
        zeros.iter().for_each(|&i| s[i] = 0.0);
        infinite.iter().for_each(|&i| b[3 * i + 1] = f64::INFINITY);
        let mut out = vec![0.0; 4 * rows];
        runner.run(Threads::new(threads), &[&s, &b], &mut [&mut out], 0..rows)
    };
    let error = |row, step, error| Err(RowError { row, step, error });
    for threads in [1, 2, 7] {
        assert_eq!(run(&[], &[], threads), Ok(()));
        assert_eq!(run(&[150_000, 20], &[30, 199_999], threads), error(20, 3, MathError::DivisionByZero));
        assert_eq!(run(&[31, 199_000], &[31, 40], threads), error(31, 2, MathError::NotFinite));
        assert_eq!(run(&[rows - 1], &[], threads), error(rows - 1, 3, MathError::DivisionByZero));
    }
}

/// Beyond the caches, and in rows of f32, which are widened and rounded once.
#[test]
fn large_and_narrow_rows_are_the_same() {
    let mut random = Random(3);
    let steps = vec![
        step(Op::Input(0), Type::ROTOR),
        step(Op::Input(1), Type::of(VECTOR)),
        step(Op::Turn(0, 1), Type::of(VECTOR)),
        step(Op::Product(Product::Wedge, 1, 2), Type::of(Grades::BIVECTOR)),
    ];
    let kinds = [Type::ROTOR, Type::of(VECTOR)].map(InputKind::Value);
    let runner = Runner::new(&program(&kinds, steps, vec![3, 2])).unwrap();
    let rows = crate::simd::traverse::STREAMED / 8 / 13 + 37;
    let [r, v] = kinds.map(|kind| random.rows(kind, rows));
    let (mut turned, mut planes) = (vec![0.0; 3 * rows], vec![0.0; 3 * rows]);
    product::turn(Threads::ONE, &r, &v, VECTOR, &mut turned);
    Plan::g3(Product::Wedge, VECTOR, VECTOR).run(Threads::ONE, &v, &turned, &mut planes);
    for path in Path::available() {
        for threads in [1, 3] {
            let (mut a, mut b) = (vec![0.5; 3 * rows], vec![0.5; 3 * rows]);
            runner.run_on(path, Threads::new(threads), &[&r, &v], &mut [&mut a, &mut b], 0..rows).unwrap();
            assert_same(&a, &planes, &format!("{path:?}"));
            assert_same(&b, &turned, &format!("{path:?}"));
        }
    }
    let narrow = |x: &[f64]| x.iter().take(300).map(|&x| x as f32).collect::<Vec<f32>>();
    let wide = |x: &[f32]| x.iter().map(|&x| x.into()).collect::<Vec<f64>>();
    let (r, v) = (narrow(&r[..280]), narrow(&v[..210]));
    let (mut a, mut b) = (vec![0.5_f32; 210], vec![0.5_f32; 210]);
    runner.run(Threads::ONE, &[&r, &v], &mut [&mut a, &mut b], 0..70).unwrap();
    let (mut planes, mut turned) = (vec![0.5; 210], vec![0.5; 210]);
    runner.run(Threads::ONE, &[&wide(&r), &wide(&v)], &mut [&mut planes, &mut turned], 0..70).unwrap();
    assert_same(&wide(&a), &wide(&narrow(&planes)), "f32");
    assert_same(&wide(&b), &wide(&narrow(&turned)), "f32");
}
