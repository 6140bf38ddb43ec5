//! Sums of products in twice the working precision.
//!
//! Ogita, Rump & Oishi, Accurate sum and dot product, SIAM J. Sci. Comput. 26 (2005) 1955–1988.

/// A sum, what rounding took from it so far, and the sum of sizes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sum {
    high: f64,
    low: f64,
    size: f64,
}

impl Sum {
    pub(crate) fn add(&mut self, x: f64) {
        let sum = self.high + x;
        let part = sum - self.high;
        self.low += (self.high - (sum - part)) + (x - part);
        self.high = sum;
        self.size += x.abs();
    }

    pub(crate) fn add_product(&mut self, x: f64, y: f64) {
        let product = x * y;
        let rest = x.mul_add(y, -product);
        self.add(product);
        self.low += rest;
    }

    pub(crate) fn value(&self) -> f64 {
        self.high + self.low
    }

    /// `Σ |x_i y_i|`: what working precision loses is a part of it.
    pub(crate) fn size(&self) -> f64 {
        self.size
    }
}
