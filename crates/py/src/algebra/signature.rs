//! The algebra of a signature: its basis, its products over arrays.

use crate::support::arrays::bad;
use polhode_ga::g3::functions::Function;
use polhode_ga::general::Calculus;
use polhode_ga::product::{Grades, Plan, Product};
use polhode_ga::rows::motors::Motors;
use polhode_ga::rows::versors::Action;
use polhode_ga::table::{self, Signature};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

type Key = (Product, Grades, Grades);

/// Actions of versors by the grades of the versor, whether it is odd, and the grades of the value.
type Actions = BTreeMap<(Grades, bool, Grades), Option<Arc<Action>>>;

/// The geometric algebra Cl(p, q, r).
#[pyclass(frozen, subclass, module = "polhode")]
pub(crate) struct Algebra {
    pub table: table::Algebra,
    plans: Mutex<BTreeMap<Key, Arc<Plan>>>,
    actions: Mutex<Actions>,
    reverse_squares: Mutex<BTreeMap<Grades, Arc<[f64]>>>,
    calculus: OnceLock<Calculus>,
    single_calculus: OnceLock<Calculus>,
    motors: OnceLock<Option<Motors>>,
}

/// A term of a product: components of the left factor, the right factor and the product, and the sign.
type Term = (usize, usize, usize, i8);

static G3: PyOnceLock<Py<Algebra>> = PyOnceLock::new();

/// The algebra of 3-d space.
#[pyfunction(name = "g3")]
pub(crate) fn g3_object(py: Python<'_>) -> PyResult<Py<Algebra>> {
    Ok(g3(py)?.clone_ref(py))
}

/// The algebra of 3-d space.
pub(crate) fn g3(py: Python<'_>) -> PyResult<&Py<Algebra>> {
    G3.get_or_try_init(py, || Py::new(py, Algebra::new(3, 0, 0, false)?))
}

/// Algebras with the maximum number of generators, from e1 and from e0.
pub(crate) fn largest(py: Python<'_>) -> PyResult<&[Py<Algebra>; 2]> {
    static LARGEST: PyOnceLock<[Py<Algebra>; 2]> = PyOnceLock::new();
    let most = table::MAX_GENERATORS;
    LARGEST.get_or_try_init(py, || {
        Ok([
            Py::new(py, Algebra::new(most, 0, 0, false)?)?,
            Py::new(py, Algebra::new(most - 1, 0, 1, true)?)?,
        ])
    })
}

impl Algebra {
    /// The plan of a product, cached.
    pub fn plan(&self, name: &str, ga: u16, gb: u16) -> PyResult<Arc<Plan>> {
        let product = Product::from_name(name).ok_or_else(|| bad(format!("unknown product {name}")))?;
        self.plan_of(product, self.check(ga)?, self.check(gb)?)
    }

    /// The plan of a product for grades of this algebra, cached.
    pub fn plan_of(&self, product: Product, ga: Grades, gb: Grades) -> PyResult<Arc<Plan>> {
        let mut plans = self.plans.lock().map_err(bad)?;
        let plan = plans
            .entry((product, ga, gb))
            .or_insert_with(|| Arc::new(Plan::new(&self.table, product, ga, gb)));
        Ok(Arc::clone(plan))
    }

    /// The action of versors on values of these grades, cached; `None` where the core cannot recognise versors.
    pub fn action(&self, versor: Grades, odd: bool, value: Grades) -> Option<Arc<Action>> {
        let mut actions = self.actions.lock().ok()?;
        let action = actions
            .entry((versor, odd, value))
            .or_insert_with(|| Action::new(&self.table, versor, odd, value).map(Arc::new));
        action.clone()
    }

    /// The functions of this algebra, with cached tables; `single` for components rounded to float32.
    pub fn calculus(&self, single: bool) -> &Calculus {
        let double = self.calculus.get_or_init(|| Calculus::new(&self.table));
        if !single {
            return double;
        }
        self.single_calculus.get_or_init(|| double.clone().rounded_to(f32::EPSILON.into()))
    }

    /// The functions of motors, if the algebra has motors of 3-d space.
    pub fn motors(&self) -> Option<&Motors> {
        self.motors.get_or_init(|| Motors::new(&self.table)).as_ref()
    }

    /// `E ~E` of the basis elements E of these grades, the product of the squares of their generators: 1, −1 or 0; cached.
    pub fn reverse_squares(&self, grades: Grades) -> Arc<[f64]> {
        let mut known = self.reverse_squares.lock().unwrap_or_else(PoisonError::into_inner);
        let found = known.entry(grades).or_insert_with(|| {
            let squares = self.table.squares();
            let square = |bits: u32| {
                (0..squares.len()).filter(|i| bits >> i & 1 == 1).map(|i| squares[i]).product::<i8>()
            };
            let held = self.table.blades().iter().filter(|blade| grades.contains(blade.grade()));
            held.map(|blade| square(blade.bits).into()).collect()
        });
        Arc::clone(found)
    }

    /// The largest magnitude u of the components E that count in the norm, those with `E ~E` not 0, and the norm in units
    /// of it, `√abs⟨A ~A⟩/u`. The unit is 1 where all are 0, or one is not finite.
    pub fn unit_and_size(row: &[f64], reverse_squares: &[f64]) -> (f64, f64) {
        let counted = || row.iter().zip(reverse_squares).filter(|(_, sign)| **sign != 0.0);
        let unit = counted().fold(0.0, |most: f64, (x, _)| most.max(x.abs()));
        let unit = if unit > 0.0 && unit.is_finite() { unit } else { 1.0 };
        let square: f64 = counted().map(|(x, sign)| sign * (x / unit) * (x / unit)).sum();
        (unit, square.abs().sqrt())
    }

    /// Whether it is the algebra of 3-d space.
    pub fn is_g3(&self) -> bool {
        self.table.signature() == table::G3.signature()
    }

    /// A set of grades of this algebra.
    pub fn check(&self, grades: u16) -> PyResult<Grades> {
        let n = self.table.signature().generators();
        if usize::from(grades) >> (n + 1) != 0 {
            return Err(bad(format!("an algebra of {n} generators has grades 0 to {n}, got {grades:#b}")));
        }
        Ok(Grades(grades))
    }
}

#[pymethods]
impl Algebra {
    /// With `from_e0`, for the signature (n, 0, 1), the null generator is e0 and comes first.
    #[new]
    #[pyo3(signature = (p, q=0, r=0, from_e0=false))]
    fn new(p: usize, q: usize, r: usize, from_e0: bool) -> PyResult<Algebra> {
        if from_e0 && (q, r) != (0, 1) {
            return Err(bad(format!("only algebras Cl(n, 0, 1) have a generator e0, got Cl({p}, {q}, {r})")));
        }
        let n = p.saturating_add(q).saturating_add(r);
        let most = table::MAX_GENERATORS;
        let table = match n > most {
            true => None,
            false if from_e0 => table::Algebra::pga(p),
            false => table::Algebra::new(Signature { p, q, r }),
        };
        let too_many = || bad(format!("an algebra must have at most {most} generators, got {p} + {q} + {r}"));
        Ok(Algebra {
            table: table.ok_or_else(too_many)?,
            plans: Mutex::default(),
            actions: Mutex::default(),
            reverse_squares: Mutex::default(),
            calculus: OnceLock::new(),
            single_calculus: OnceLock::new(),
            motors: OnceLock::new(),
        })
    }

    /// The numbers of generators with square +1, −1 and 0.
    #[getter]
    fn signature(&self) -> (usize, usize, usize) {
        let Signature { p, q, r } = self.table.signature();
        (p, q, r)
    }

    /// The square of each generator: 1, −1 or 0.
    fn _squares(&self) -> Vec<i8> {
        self.table.squares().to_vec()
    }

    /// The number in the name of the first generator: 1, or 0 where e0 comes first.
    fn _first(&self) -> usize {
        self.table.numbers().start
    }

    /// The generators of each basis element, as bits, and its sign against their rising order.
    fn _blades(&self) -> Vec<(u32, i8)> {
        self.table.blades().iter().map(|b| (b.bits, b.sign)).collect()
    }

    /// Indices of the components of these grades, as bits, among all.
    fn _indices(&self, grades: u16) -> PyResult<Vec<usize>> {
        Ok(self.check(grades)?.indices(&self.table))
    }

    /// `E ~E` of the basis elements E of these grades: 1, −1 or 0.
    fn _squares_of(&self, grades: u16) -> PyResult<Vec<f64>> {
        Ok(self.reverse_squares(self.check(grades)?).to_vec())
    }

    /// The grades of `inverse`, `exp`, `log` or `sqrt` of values that hold these grades.
    fn _grades_of_function(&self, name: &str, grades: u16) -> PyResult<u16> {
        let f = Function::from_name(name).ok_or_else(|| bad(format!("unknown function {name}")))?;
        let grades = self.check(grades)?;
        Ok(if self.is_g3() { f.grades(grades).0 } else { self.calculus(false).grades(f, grades).0 })
    }

    /// Where each basis element goes by the right complement, and with which sign.
    fn _right_complement(&self) -> Vec<(usize, f64)> {
        let size = self.table.blades().len();
        let image = |i: usize| {
            let mut element = vec![0.0; size];
            element[i] = 1.0;
            let complement = self.calculus(false).right_complement(&element);
            complement.into_iter().enumerate().find(|(_, x)| *x != 0.0).unwrap_or((i, 0.0))
        };
        (0..size).map(image).collect()
    }

    /// The grades of a product of values that hold these grades, and its number of components.
    fn _result(&self, name: &str, a: u16, b: u16) -> PyResult<(u16, usize)> {
        let plan = self.plan(name, a, b)?;
        Ok((plan.grades.0, plan.sizes.2))
    }

    /// The terms of a product of values that hold these grades, and the grades of the product.
    fn _terms(&self, name: &str, a: u16, b: u16) -> PyResult<(Vec<Term>, u16)> {
        let plan = self.plan(name, a, b)?;
        Ok((plan.terms.iter().map(|t| (t.a, t.b, t.out, t.sign)).collect(), plan.grades.0))
    }
}
