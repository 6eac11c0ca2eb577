//! Interpreter: a formula over many rows gives the same bits, and the same error, as over single rows, whose products are
//! those of the blade table; on lanes too, where a row with an error has no value.
#![no_main]

mod names;
mod table;

use libfuzzer_sys::fuzz_target;
use names::BOUND;
use polhode_ga::formula::{Given, InputKind, Op, Program, Runner, Space, compile, parse};
use polhode_ga::graded::Graded;
use polhode_ga::product::Grades;
use polhode_ga::simd::threads::Threads;
use polhode_ga::table::G3;

// The number of rows, the seed of the components, and the text.
fuzz_target!(|data: (u8, u64, &str)| {
    let (rows, seed, text) = data;
    let Ok(tree) = parse(text, Space::g3(), &BOUND) else { return };
    let Ok(program) = compile(&tree, Space::g3(), &BOUND) else { return };
    if program.steps.len() < 1000 {
        check_rows(&program, 1 + usize::from(rows), seed);
        check_lanes(&program, seed);
    }
});

fn check_rows(program: &Program, rows: usize, mut seed: u64) {
    let runner = Runner::new(program).expect("a program of 3-d space");
    let inputs: Vec<Vec<f64>> = program
        .inputs
        .iter()
        .map(|input| {
            let rows = if random(&mut seed) < 0.0 { 1 } else { rows };
            (0..rows).flat_map(|_| components(input.kind, &mut seed)).collect()
        })
        .collect();
    let results = program.results.concat();
    let sizes: Vec<usize> = results.iter().map(|&id| size(program.steps[id].ty.grades)).collect();
    let mut outputs: Vec<Vec<f64>> = sizes.iter().map(|size| vec![0.0; size * rows]).collect();

    let given: Vec<&[f64]> = inputs.iter().map(Vec::as_slice).collect();
    let mut places: Vec<&mut [f64]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
    let outcome = runner.run(Threads::ONE, &given, &mut places, 0..rows);

    for row in 0..rows {
        let kinds = program.inputs.iter().map(|input| input.kind);
        let one: Vec<Given> =
            kinds.zip(&inputs).map(|(kind, data)| given_row(kind, data, rows, row)).collect();
        match (runner.value(&one), outcome) {
            (Ok(_), Err(error)) => assert_ne!(error.row, row, "{error:?}"),
            (Ok(values), Ok(())) => {
                check_products(&program, &values);
                for ((id, size), output) in results.iter().zip(&sizes).zip(&outputs) {
                    let (found, expected) = (&output[row * size..][..*size], values[*id].components());
                    assert!(found.iter().zip(expected).all(same), "row {row}: {found:?}, alone {expected:?}");
                }
            }
            (Err((step, error)), Err(found)) => {
                assert_eq!((found.row, found.step, found.error), (row, step, error));
                return;
            }
            (Err((_, error)), Ok(())) => panic!("row {row}: {error:?}"),
        }
    }
}

/// On lanes, with some inputs the same for all rows, and one number that is sometimes shared and announced.
fn check_lanes(program: &Program, mut seed: u64) {
    const ROWS: usize = 8;
    let runner = Runner::new(program).expect("a program of 3-d space");
    let kinds: Vec<InputKind> = program.inputs.iter().map(|input| input.kind).collect();
    let mut draw = |kind: InputKind| {
        let numbers = components(kind, &mut seed);
        (given_row(kind, &numbers, 1, 0), random(&mut seed) < 0.0)
    };
    let known: Vec<Option<Given>> = kinds
        .iter()
        .map(|&kind| Some(draw(kind)).filter(|(_, known)| *known).map(|(given, _)| given))
        .collect();
    let fixed = fixed(program, &known);
    let parameter = (0..kinds.len()).find(|&i| known[i].is_none() && kinds[i].size() == 1);
    let mut beside = runner.beside::<ROWS>(&known, parameter);
    for _ in 0..4 {
        let mut rows: Vec<[Given; ROWS]> =
            kinds.iter().map(|&kind| [(); ROWS].map(|()| draw(kind).0)).collect();
        for (row, known) in rows.iter_mut().zip(&known) {
            row.iter_mut().for_each(|given| *given = known.unwrap_or(*given));
        }
        if let Some(i) = parameter {
            let (other, shared) = draw(kinds[i]);
            if shared {
                rows[i] = [rows[i][0]; ROWS];
            }
            if let Some(beside) = &mut beside {
                let numbers = rows[i].each_ref().map(|given| given.numbers()[0]);
                if draw(kinds[i]).1 {
                    beside.foresee([other.numbers()[0], numbers[0], numbers[0], numbers[7]].into_iter());
                }
                beside.set_parameter(i, &numbers);
            }
        }
        if let Some(beside) = &mut beside {
            for i in (0..kinds.len()).filter(|&i| known[i].is_none() && Some(i) != parameter) {
                for (row, given) in rows[i].iter().enumerate() {
                    let lanes = beside.input(i).iter_mut();
                    lanes.zip(given.numbers()).for_each(|(lane, x)| lane.0[row] = *x);
                }
            }
            beside.run();
        }
        for row in 0..ROWS {
            let one: Vec<Given> = rows.iter().map(|rows| rows[row]).collect();
            let values = runner.value(&one);
            let Some(beside) = &beside else {
                assert!(values.is_err(), "a known step fails on lanes only");
                continue;
            };
            for (number, &id) in program.results.concat().iter().enumerate() {
                let found: Vec<f64> = beside.result(number).iter().map(|lane| lane.0[row]).collect();
                match &values {
                    Ok(values) => {
                        let alone = values[id].components();
                        assert!(found.iter().zip(alone).all(same), "row {row}: {found:?}, alone {alone:?}");
                    }
                    Err(error) => {
                        assert!(fixed[id] || found.iter().all(|x| x.is_nan()), "{error:?}: {found:?}")
                    }
                }
            }
        }
    }
}

/// Whether each step has the same value for all rows.
fn fixed(program: &Program, known: &[Option<Given>]) -> Vec<bool> {
    let mut fixed: Vec<bool> = Vec::new();
    for step in &program.steps {
        let own = match step.op {
            Op::Input(input) | Op::Map { input, .. } => known[input].is_some(),
            _ => true,
        };
        fixed.push(own && step.op.operands().all(|id| fixed[id]));
    }
    fixed
}

/// Each product of two steps, by the table; a step keeps some grades of it.
fn check_products(program: &Program, values: &[Graded]) {
    for (step, value) in program.steps.iter().zip(values) {
        if let Op::Product(product, a, b) = step.op {
            let full = |of: &[f64]| Graded::full(&whole(of).with_grades(value.grades())).to_vec();
            let (sums, sizes) = table::product(&G3, product, &values[a].full(), &values[b].full());
            table::assert_close(&value.full(), &(full(&sums), full(&sizes)), 8, product.name());
        }
    }
}

fn whole(components: &[f64]) -> Graded {
    Graded::new(components, Grades::ALL).expect("eight components")
}

fn same((a, b): (&f64, &f64)) -> bool {
    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
}

fn size(grades: Grades) -> usize {
    grades.indices(&G3).len()
}

/// A number from −2 to 2.
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    ((*seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5) * 4.0
}

/// A number from −2 to 2, and one in four from the edges of the range.
fn component(seed: &mut u64) -> f64 {
    const EDGES: [f64; 8] = [0.0, -0.0, 1.0, 1e-310, -1e-160, 1e160, f64::MAX, f64::INFINITY];
    let number = random(seed);
    if number < 1.0 { number } else { EDGES[((number - 1.0) * 8.0) as usize] }
}

fn components(kind: InputKind, seed: &mut u64) -> Vec<f64> {
    match kind {
        InputKind::Value(ty) if ty.unit => {
            let four: [f64; 4] = std::array::from_fn(|_| random(seed));
            let norm = four.iter().map(|x| x * x).sum::<f64>().sqrt();
            four.map(|x| x / norm).to_vec()
        }
        InputKind::Value(ty) => (0..size(ty.grades)).map(|_| component(seed)).collect(),
        InputKind::Matrix { .. } => (0..9).map(|_| component(seed)).collect(),
        InputKind::Determinant => vec![component(seed)],
    }
}

fn given_row(kind: InputKind, data: &[f64], rows: usize, row: usize) -> Given {
    let size = match kind {
        InputKind::Value(ty) => size(ty.grades),
        InputKind::Matrix { .. } => 9,
        InputKind::Determinant => 1,
    };
    let row = if data.len() == size && rows > 1 { 0 } else { row };
    let numbers = &data[row * size..][..size];
    match kind {
        InputKind::Value(ty) => Given::Value(Graded::new(numbers, ty.grades).expect("so many components")),
        InputKind::Matrix { .. } => Given::Matrix(numbers.try_into().expect("nine numbers")),
        InputKind::Determinant => Given::Determinant(numbers[0]),
    }
}
