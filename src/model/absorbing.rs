//! The profile of the absorbing boundary: `#pml_cfs` and `#pml_formulation`.

/// How a quantity changes over an absorbing slab, from its entrance to the wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grading {
    /// Power of the depth, 0 to 8; with 0 the quantity is `max` throughout.
    pub order: u8,
    /// Whether it falls from the entrance to the wall instead of growing.
    pub reverse: bool,
    /// The least value.
    pub min: f64,
    /// The largest value; `None` for a conductivity that is chosen by the media at the entrance.
    pub max: Option<f64>,
}

impl Grading {
    /// The words of `#pml_cfs` for the orders from 0 on.
    pub const ORDERS: [&'static str; 9] =
        ["constant", "linear", "quadratic", "cubic", "quartic", "quintic", "sextic", "septic", "octic"];

    /// The same value throughout.
    pub const fn constant(value: f64) -> Self {
        Self { order: 0, reverse: false, min: value, max: Some(value) }
    }

    /// The value at a depth, 0 at the entrance and 1 at the wall, with the largest value as given or chosen.
    pub fn at(&self, depth: f64, max: f64) -> f64 {
        if self.order == 0 {
            return max;
        }
        let depth = if self.reverse { 1.0 - depth } else { depth };
        self.min + (max - self.min) * depth.powi(i32::from(self.order))
    }
}

/// One factor (or term) of the stretch of an absorbing boundary, `kappa + sigma/(alpha + i w eps0)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Shift of the frequency, S/m.
    pub alpha: Grading,
    /// Real stretch.
    pub kappa: Grading,
    /// Conductivity, S/m.
    pub sigma: Grading,
}

impl Default for Stretch {
    fn default() -> Self {
        let sigma = Grading { order: 4, reverse: false, min: 0.0, max: None };
        Self { alpha: Grading::constant(0.0), kappa: Grading::constant(1.0), sigma }
    }
}

/// How two stretches work together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Formulation {
    /// One after the other, their product (`HORIPML`).
    #[default]
    Recursive,
    /// Their sum (`MRIPML`).
    Multipole,
}

impl Formulation {
    /// The word of `#pml_formulation`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Recursive => "HORIPML",
            Self::Multipole => "MRIPML",
        }
    }
}

/// The profile of the absorbing boundary.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AbsorbingProfile {
    /// How two stretches work together.
    pub formulation: Formulation,
    /// At most two; none stands for one [`Stretch::default`].
    pub stretches: Vec<Stretch>,
}

impl AbsorbingProfile {
    /// The stretches, one at least.
    pub fn factors(&self) -> Vec<Stretch> {
        if self.stretches.is_empty() { vec![Stretch::default()] } else { self.stretches.clone() }
    }

    /// Whether the loops for a plane know it: one stretch that does nothing at the entrance.
    pub fn fits_a_plane(&self) -> bool {
        let factors = self.factors();
        let [stretch] = &factors[..] else { return false };
        let nothing = |grading: &Grading, value: f64| match grading.max {
            Some(max) => grading.at(0.0, max) == value,
            None => grading.order > 0 && !grading.reverse && grading.min == value,
        };
        nothing(&stretch.kappa, 1.0) && nothing(&stretch.sigma, 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The samples that gprMax 4.0.1 prints when it refuses a profile of six cells: a conductivity of 3 S/m that grows with
    /// the sixth power is 0.263374 at the fourth node, an alpha of 0.07 that falls linearly 0.0233333, a kappa of 2 that
    /// grows with the square 1.44444.
    #[test]
    fn gradings_are_those_of_gprmax() {
        let at = |order, reverse, min, max| Grading { order, reverse, min, max: Some(max) }.at(4.0 / 6.0, max);
        assert!((at(6, false, 0.0, 3.0) - 0.263374).abs() < 5e-7);
        assert!((at(1, true, 0.0, 0.07) - 0.0233333).abs() < 5e-8);
        assert!((at(2, false, 1.0, 2.0) - 1.44444).abs() < 5e-6);
    }

    #[test]
    fn the_plane_knows_one_stretch_that_does_nothing_at_the_entrance() {
        let with = |stretches| AbsorbingProfile { formulation: Formulation::Recursive, stretches };
        let default = Stretch::default();
        assert!(with(vec![]).fits_a_plane() && with(vec![default]).fits_a_plane());
        assert!(!with(vec![default, default]).fits_a_plane());
        assert!(with(vec![Stretch { alpha: Grading::constant(0.05), ..default }]).fits_a_plane());
        assert!(!with(vec![Stretch { kappa: Grading::constant(2.0), ..default }]).fits_a_plane());
    }
}
