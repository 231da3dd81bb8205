//! Permittivity of a layer from picked times or amplitudes.

use crate::units::constants::C0;
use crate::units::{Metres, Seconds};

/// Amplitudes from which no permittivity follows.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum AmplitudeError {
    /// An echo as strong as that of the plate, or stronger.
    #[error(
        "an echo of {ratio:.3} times the plate's gives no permittivity: it should be between -1 and 1\n\nhint: is the plate smaller than the footprint of the antenna, or was it measured at another height?"
    )]
    NotAReflection {
        /// Amplitude over that of the plate.
        ratio: f64,
    },
    /// Echoes that together reflect all.
    #[error("echoes of {surface:.3} and {layer:.3} times the plate's leave nothing for the next layer")]
    NothingLeft {
        /// Surface echo over the plate's.
        surface: f64,
        /// Layer echo over the plate's.
        layer: f64,
    },
}

/// Computes the relative permittivity of a layer of known depth from its two-way travel time (time-domain signal picking,
/// TDSP): `(c t / 2 h)^2`.
///
/// ```
/// use ballast_gpr::compare::permittivity::from_two_way_time;
/// use ballast_gpr::units::{Metres, Seconds};
/// // Tank of 39 % voids: surface at 2.6685 ns, base of the 0.48 m of ballast at 8.8975 ns.
/// let eps_r = from_two_way_time(Seconds(8.8975e-9 - 2.6685e-9), Metres(0.48));
/// assert!((eps_r - 3.7838).abs() < 2e-4);
/// ```
pub fn from_two_way_time(two_way_time: Seconds, depth: Metres) -> f64 {
    (C0 * two_way_time.si() / (2.0 * depth.si())).powi(2)
}

/// Computes the two-way travel time through a layer of `depth`, at normal incidence, without loss.
pub fn two_way_time(depth: Metres, eps_r: f64) -> Seconds {
    Seconds(2.0 * depth.si() * eps_r.sqrt() / C0)
}

/// Computes the relative permittivity of the surface from its echo and that of a metal plate at the same height (surface
/// reflection method, SRM): `[(1 + A0/Apec)/(1 - A0/Apec)]^2`.
///
/// Amplitudes with their signs, so that ballast and plate have the same. A rough surface or a plate smaller than the
/// footprint of the antenna spoil it: on the tank it was judged unusable.
///
/// # Errors
/// An echo as strong as the plate's or stronger.
pub fn from_surface_reflection(surface: f64, plate: f64) -> Result<f64, AmplitudeError> {
    let ratio = reflection(surface, plate)?;
    Ok(((1.0 + ratio) / (1.0 - ratio)).powi(2))
}

/// Computes the relative permittivity of the layer below one of `eps_r`, from the echoes of both and of a metal plate:
/// `eps_r [(1 - R0^2 + R1)/(1 - R0^2 - R1)]^2` with `R = A/Apec`.
///
/// Without loss and with normal incidence.
///
/// # Errors
/// Echoes as strong as the plate's, or together stronger.
pub fn of_next_layer(eps_r: f64, surface: f64, layer: f64, plate: f64) -> Result<f64, AmplitudeError> {
    let (r0, r1) = (reflection(surface, plate)?, reflection(layer, plate)?);
    let passed = 1.0 - r0 * r0;
    if r1.abs() >= passed {
        return Err(AmplitudeError::NothingLeft { surface: r0, layer: r1 });
    }
    Ok(eps_r * ((passed + r1) / (passed - r1)).powi(2))
}

/// Computes the reflection of a plane wave from air onto a medium at normal incidence: `(1 - sqrt eps)/(1 + sqrt eps)`.
pub fn surface_reflection(eps_r: f64) -> f64 {
    (1.0 - eps_r.sqrt()) / (1.0 + eps_r.sqrt())
}

fn reflection(echo: f64, plate: f64) -> Result<f64, AmplitudeError> {
    let ratio = echo / plate;
    if ratio.abs() < 1.0 { Ok(ratio) } else { Err(AmplitudeError::NotAReflection { ratio }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Facts: 3.5 -> -0.30, 4.4 -> -0.35, 5.35 -> -0.40; a metal plate is -1.
    #[test]
    fn surface_reflections_and_back() {
        for (eps_r, r) in [(3.5, -0.30), (4.4, -0.35), (5.35, -0.40)] {
            assert!((surface_reflection(eps_r) - r).abs() < 0.005);
            assert!((from_surface_reflection(surface_reflection(eps_r), -1.0).unwrap() - eps_r).abs() < 1e-12);
        }
    }

    /// Second echo of a lossless stack 1 / 3.6 / 5.9: `(1 - r01^2) r12`, `r12 = (sqrt 3.6 - sqrt 5.9)/(sqrt 3.6 + sqrt 5.9)`.
    #[test]
    fn next_layer_and_back() {
        let (first, second): (f64, f64) = (3.6, 5.9);
        let r01 = surface_reflection(first);
        let r12 = (first.sqrt() - second.sqrt()) / (first.sqrt() + second.sqrt());
        let found = of_next_layer(first, 2.0 * r01, 2.0 * (1.0 - r01 * r01) * r12, -2.0).unwrap();
        assert!((found - second).abs() < 1e-12);
    }

    #[test]
    fn amplitudes_that_give_nothing_are_refused_word_for_word() {
        assert_eq!(
            from_surface_reflection(-1.2, -1.0).unwrap_err().to_string(),
            "an echo of 1.200 times the plate's gives no permittivity: it should be between -1 and 1\n\nhint: is the plate smaller than the footprint of the antenna, or was it measured at another height?"
        );
        assert!(from_surface_reflection(0.5, 0.0).is_err());
        assert_eq!(
            of_next_layer(4.0, 0.8, 0.5, 1.0).unwrap_err().to_string(),
            "echoes of 0.800 and 0.500 times the plate's leave nothing for the next layer"
        );
    }

    #[test]
    fn time_and_permittivity_are_inverse() {
        let t = two_way_time(Metres(0.48), 3.605);
        assert!((from_two_way_time(t, Metres(0.48)) - 3.605).abs() < 1e-12);
    }
}
