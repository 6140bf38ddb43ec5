//! Numbers that look random and are the same in every run: xorshift64 (Marsaglia, J. Stat. Softw. 8 (2003) no. 14).

/// A seed that is not zero, and what becomes of it.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// In [0, 1).
    pub(crate) fn part(&mut self) -> f64 {
        for (left, by) in [(true, 13), (false, 7), (true, 17)] {
            self.0 ^= if left { self.0 << by } else { self.0 >> by };
        }
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

#[cfg(feature = "cli")]
impl Random {
    /// One of many streams that have nothing in common.
    pub(crate) fn stream(seed: u64, number: u64) -> Self {
        let mixed = seed.wrapping_add(number);
        let mut random = Self(mixed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
        // The first numbers of near seeds are near.
        for _ in 0..8 {
            random.part();
        }
        random
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.part()
    }

    /// In 0 … count − 1.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.part() * count as f64) as usize
    }

    /// The numbers 0 … count − 1 in some order.
    pub(crate) fn shuffled(&mut self, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..count).collect();
        for last in (1..count).rev() {
            order.swap(last, self.below(last + 1));
        }
        order
    }
}
