//! Three numbers as a vector; four as what fits a register.

/// Four numbers in half a line of the cache: a vector and something that belongs to it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[repr(C, align(32))]
pub struct Four(pub [f64; 4]);

impl Four {
    /// Joins a vector and a number.
    #[inline(always)]
    pub fn new([x, y, z]: [f64; 3], w: f64) -> Self {
        Self([x, y, z, w])
    }

    /// The vector.
    #[inline(always)]
    pub fn xyz(self) -> [f64; 3] {
        [self.0[0], self.0[1], self.0[2]]
    }

    /// The number.
    #[inline(always)]
    pub fn w(self) -> f64 {
        self.0[3]
    }
}

/// The scalar product.
#[inline(always)]
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector product.
#[inline(always)]
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The length.
#[inline(always)]
pub fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// A multiple.
#[inline(always)]
pub fn scale(by: f64, a: [f64; 3]) -> [f64; 3] {
    a.map(|v| by * v)
}

/// The sum.
#[inline(always)]
pub fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// The difference.
#[inline(always)]
pub fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}
