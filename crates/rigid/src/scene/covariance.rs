//! Normal variations of several parameters with a covariance.
//!
//! ```toml
//! [ensemble]
//! covariance = { of = ["spin", "torque.damping"], matrix = [[…], …] }   # 4 × 4, in SI units
//! ```
//!
//! Standard normal numbers u, those that each parameter would have alone, become `z = T u` with the lower triangular
//! matrix T of `C = T Tᵀ` (Cholesky). A diagonal matrix gives the draws of `normal` with the widths `√C_kk`.

use super::reader::{Reader, Table, Value};
use super::spread::Noise;
use crate::random::normal;

/// Allowed relative difference of two numbers that must be equal, and of a variance that must not be negative: matrices
/// from computations are symmetric and semidefinite to rounding only.
const ROUNDING: f64 = 1e-12;

/// Parameters that vary together.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariance {
    /// Names of the parameters, and how many numbers each has.
    parameters: Vec<(String, usize)>,
    /// The rows of T.
    rows: Vec<Vec<f64>>,
}

/// One of the parameters of a covariance.
pub struct Joint<'c> {
    covariance: &'c Covariance,
    index: usize,
}

impl Covariance {
    /// The parameter of this name.
    pub fn find(&self, name: &str) -> Option<Joint<'_>> {
        let index = self.parameters.iter().position(|(own, _)| own == name)?;
        Some(Joint { covariance: self, index })
    }

    /// For each number of a parameter, from its first: the standard deviation, and the largest draw over that of a
    /// standard normal number.
    pub fn widths(&self, first: usize, size: usize) -> [[f64; 3]; 2] {
        let row = |k: usize| &self.rows[first + if size == 1 { 0 } else { k }];
        let deviation = |k| row(k).iter().map(|x| x * x).sum::<f64>().sqrt();
        let reach = |k| row(k).iter().map(|x| x.abs()).sum();
        [std::array::from_fn(deviation), std::array::from_fn(reach)]
    }
}

impl<'c> Joint<'c> {
    /// The names of the parameters up to this one, on which it depends.
    pub fn names(&self) -> impl Iterator<Item = &'c str> + use<'c> {
        self.covariance.parameters[..=self.index].iter().map(|(name, _)| name.as_str())
    }

    /// Its numbers, from the random words of [`Joint::names`]; a single one three times.
    pub fn noise(&self, words: &[[u64; 8]]) -> Noise {
        let parameters = &self.covariance.parameters[..=self.index];
        let normals: Vec<f64> = words
            .iter()
            .zip(parameters)
            .flat_map(|(words, (_, size))| words[..*size].iter().map(|word| normal(*word)))
            .collect();
        let size = parameters[self.index].1;
        let first = normals.len() - size;
        Noise::Normals(std::array::from_fn(|k| {
            let row = &self.covariance.rows[first + if size == 1 { 0 } else { k }];
            row.iter().zip(&normals).map(|(x, u)| x * u).sum()
        }))
    }
}

/// Reads a covariance; `size` is how many numbers a parameter has, None for one that cannot vary (reported by it).
pub fn read(
    reader: &mut Reader,
    value: &Value,
    mut size: impl FnMut(&mut Reader, &Value, &str) -> Option<usize>,
) -> Option<Covariance> {
    let table: &Table = &reader.table(value, "`covariance`")?;
    reader.only(table, &["of", "matrix"]);
    let parameters = reader.field(table, "of", |reader, value| {
        reader
            .list(value, "names", |reader, item| {
                let name = reader.string(item)?;
                Some((name.to_owned(), size(reader, item, name)?))
            })
            .filter(|names| {
                if names.is_empty() {
                    reader.report(
                        value.span(),
                        "no names; write at least one random parameter, such as `spin`",
                    );
                }
                !names.is_empty()
            })
    });
    let matrix = reader.field(table, "matrix", |reader, value| {
        let row =
            |reader: &mut Reader, row: &Value| reader.list(row, "numbers", |reader, x| reader.number(x));
        Some((value.span(), reader.list(value, "rows", row)?))
    });
    let (parameters, (span, matrix)) = (parameters?, matrix?);
    for (index, (name, _)) in parameters.iter().enumerate() {
        if parameters[..index].iter().any(|(other, _)| other == name) {
            reader.report(value.span(), format!("`{name}` is named twice"));
            return None;
        }
    }
    let names: Vec<String> = parameters.iter().flat_map(|(name, size)| numbered(name, *size)).collect();
    if let Some(found) = other_shape(&matrix, names.len()) {
        let (n, of) = (names.len(), names.join(", "));
        reader.report(span, format!("expected {n} rows of {n} numbers, for {of}; {found}"));
        return None;
    }
    match factor(&matrix, &names) {
        Ok(rows) => Some(Covariance { parameters, rows }),
        Err(why) => {
            reader.report(span, why);
            None
        }
    }
}

/// The shape of a matrix that does not have n rows of n numbers.
fn other_shape(matrix: &[Vec<f64>], n: usize) -> Option<String> {
    let plural = |k: usize, what: &str| format!("{k} {what}{}", if k == 1 { "" } else { "s" });
    if matrix.len() != n {
        return Some(format!("found {}", plural(matrix.len(), "row")));
    }
    let (index, row) = matrix.iter().enumerate().find(|(_, row)| row.len() != n)?;
    Some(format!("row {} of them has {}", index + 1, plural(row.len(), "number")))
}

fn numbered(name: &str, size: usize) -> Vec<String> {
    match size {
        1 => vec![name.to_owned()],
        _ => (0..size).map(|k| format!("{name}[{k}]")).collect(),
    }
}

/// The rows of the lower triangular T of `C = T Tᵀ`; those of numbers without a variance of their own end with 0.
fn factor(matrix: &[Vec<f64>], names: &[String]) -> Result<Vec<Vec<f64>>, String> {
    let scale = |i: usize, j: usize| (matrix[i][i] * matrix[j][j]).sqrt();
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for i in 0..matrix.len() {
        let variance = matrix[i][i];
        if variance < 0.0 {
            return Err(format!("the variance of {} must not be negative, found {variance}", names[i]));
        }
        let mut row: Vec<f64> = Vec::new();
        for j in 0..i {
            let (x, y) = (matrix[i][j], matrix[j][i]);
            if (x - y).abs() > ROUNDING * scale(i, j) {
                let (a, b) = (&names[i], &names[j]);
                return Err(format!(
                    "the matrix is not symmetric: {x} for {a} and {b}, but {y} for {b} and {a}"
                ));
            }
            let rest = x - row.iter().zip(&rows[j]).map(|(a, b)| a * b).sum::<f64>();
            let pivot = rows[j][j];
            if pivot == 0.0 && rest.abs() > ROUNDING.sqrt() * scale(i, j) {
                let (a, b) = (&names[i], &names[j]);
                return Err(format!(
                    "the matrix is not positive semidefinite: {b} follows from the numbers before it, so its covariance with {a} must be {}, found {x}",
                    x - rest
                ));
            }
            row.push(if pivot == 0.0 { 0.0 } else { rest / pivot });
        }
        let rest = variance - row.iter().map(|x| x * x).sum::<f64>();
        if rest < -ROUNDING * variance {
            let least = variance - rest;
            return Err(format!(
                "the matrix is not positive semidefinite: its covariances with the numbers before it need a variance of {} of at least {least}, found {variance}",
                names[i]
            ));
        }
        row.push(if rest <= ROUNDING * variance { 0.0 } else { rest.sqrt() });
        rows.push(row);
    }
    Ok(rows)
}

#[cfg(test)]
mod tests;
