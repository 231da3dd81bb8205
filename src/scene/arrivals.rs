//! Exact arrival times of a plane wave at normal incidence on horizontal layers.

use crate::units::constants::C0;
use crate::units::{Metres, Seconds};

/// A horizontal layer, from the top down.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Layer {
    /// Name to show.
    pub name: String,
    /// Thickness.
    pub thickness: Metres,
    /// Relative permittivity (real, at the centre frequency).
    pub eps_r: f64,
}

/// Two-way travel times from the antenna, counted from the emission.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Arrivals {
    /// Echo of the bed's surface.
    pub surface: Seconds,
    /// Echo of the lower face of each layer but the last, with the name of the layer above it.
    pub interfaces: Vec<(String, Seconds)>,
    /// Echo of the metal plate below the last layer.
    pub plate: Seconds,
    /// Reflection coefficient of the surface, `(1 - sqrt(eps)) / (1 + sqrt(eps))`.
    pub surface_reflection: f64,
}

/// Two-way travel times through air of `height` and then `layers`, lossless.
pub fn arrivals(height: Metres, layers: &[Layer]) -> Arrivals {
    let mut time = 2.0 * height.si() / C0;
    let surface = Seconds(time);
    let mut interfaces = Vec::new();
    for layer in layers {
        time += 2.0 * layer.thickness.si() * layer.eps_r.sqrt() / C0;
        interfaces.push((layer.name.clone(), Seconds(time)));
    }
    interfaces.pop();
    let index = layers.first().map_or(1.0, |layer| layer.eps_r.sqrt());
    Arrivals { surface, interfaces, plate: Seconds(time), surface_reflection: (1.0 - index) / (1.0 + index) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The clean tank and the one with 20 cm of fouling, 42 % voids, against `validation/tank` (computed independently).
    #[test]
    fn arrivals_are_those_of_the_table() {
        let base = Layer { name: "base".into(), thickness: Metres(0.04), eps_r: 4.0 };
        let clean = [Layer { name: "clean".into(), thickness: Metres(0.48), eps_r: 3.6051 }, base.clone()];
        let found = arrivals(Metres(0.40), &clean);
        assert!((found.surface.si() * 1e9 - 2.6685).abs() < 5e-5);
        assert!((found.plate.si() * 1e9 - 9.2823).abs() < 1e-4);
        assert!((found.surface_reflection + 0.3100).abs() < 5e-5);
        let fouled = [
            Layer { name: "clean".into(), thickness: Metres(0.28), eps_r: 3.6051 },
            Layer { name: "fouled".into(), thickness: Metres(0.20), eps_r: 5.8597 },
            base,
        ];
        let found = arrivals(Metres(0.40), &fouled);
        assert!((found.interfaces[0].1.si() * 1e9 - 6.2152).abs() < 1e-4);
        assert!((found.plate.si() * 1e9 - 9.9787).abs() < 1e-4);
    }
}
