//! Lookahead: numbers are announced before they are used, so that functions of them are computed for many at once.

/// Numbers in the order in which they will be used.
#[derive(Clone, Debug, Default)]
pub struct Lookahead {
    numbers: Vec<f64>,
    /// The place of the one that was found last.
    last: usize,
}

impl Lookahead {
    /// The number of places after the last one at which a number is looked for.
    const NEAR: usize = 4;

    /// Announces numbers instead of those before; equal neighbours are one.
    pub fn announce(&mut self, numbers: impl Iterator<Item = f64>) -> &[f64] {
        self.numbers.clear();
        self.numbers.extend(numbers);
        self.numbers.dedup_by_key(|x| x.to_bits());
        self.last = 0;
        &self.numbers
    }

    /// The place of a number, if it is near the one that was found last.
    pub fn find(&mut self, number: f64) -> Option<usize> {
        let near = self.numbers[self.last..].iter().take(Self::NEAR);
        self.last += near.map(|x| x.to_bits()).position(|bits| bits == number.to_bits())?;
        Some(self.last)
    }
}
