//! The permittivity of a mixture from its parts.

use super::{Complex, Dielectric};
use crate::units::{Hertz, Share};

/// A rule that turns the permittivities of the parts into that of the whole.
///
/// Reads and writes itself as `crim`, `looyenga`, `lichtenecker`, `birchak:0.4`, `arithmetic`, `harmonic`,
/// `maxwell-garnett`, `maxwell-garnett-2d-te`, `bruggeman`, `bruggeman-2d`; `maxwell-garnett-2d-tm` is read as
/// `arithmetic`, which it is.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum MixingModel {
    /// Complex refractive index model: Birchak with exponent 1/2, the volumetric mixing formula of the ballast literature.
    Crim,
    /// Exponent 1/3.
    Looyenga,
    /// Logarithmic law, the limit of Birchak for exponent zero.
    Lichtenecker,
    /// `eps^a = sum f_i eps_i^a` (Birchak 1974), with `a` in -1…1.
    Birchak(f64),
    /// Arithmetic mean, the upper Wiener bound: exact for the field along cylinders (2-D TM).
    Arithmetic,
    /// Harmonic mean, the lower Wiener bound: exact for the field across layers.
    Harmonic,
    /// Maxwell Garnett with spheres; the first part is the host.
    MaxwellGarnett,
    /// Maxwell Garnett with cylinders and the field across them (2-D TE); the first part is the host.
    MaxwellGarnett2dTe,
    /// Bruggeman's symmetric rule with spheres.
    Bruggeman,
    /// Bruggeman's symmetric rule with cylinders and the field across them (2-D TE).
    Bruggeman2d,
}

const NAMES: [(&str, MixingModel); 9] = [
    ("crim", MixingModel::Crim),
    ("looyenga", MixingModel::Looyenga),
    ("lichtenecker", MixingModel::Lichtenecker),
    ("arithmetic", MixingModel::Arithmetic),
    ("harmonic", MixingModel::Harmonic),
    ("maxwell-garnett", MixingModel::MaxwellGarnett),
    ("maxwell-garnett-2d-te", MixingModel::MaxwellGarnett2dTe),
    ("bruggeman", MixingModel::Bruggeman),
    ("bruggeman-2d", MixingModel::Bruggeman2d),
];

/// How far the shares may be from one in sum: rounding in decimal, no more.
const SHARES_TOLERANCE: f64 = 1e-9;

/// Why a mixture could not be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MixError {
    /// No parts.
    #[error("a mixture needs at least one part")]
    NoParts,
    /// The shares do not make a whole.
    #[error("the shares of a mixture should sum to 100%, these sum to {sum}\n\nhint: give the rest to `air`")]
    SharesDoNotSum {
        /// Their sum.
        sum: Share,
    },
    /// A share below zero or not a number.
    #[error("share {number} of the mixture is {share}: it should be between 0% and 100%")]
    Share {
        /// Which part, counted from 1.
        number: usize,
        /// Its share.
        share: Share,
    },
    /// A permittivity that no passive material has.
    #[error(
        "permittivity {number} of the mixture is {eps}: its real part should be above 0 and its imaginary part 0 or below"
    )]
    Permittivity {
        /// Which part, counted from 1.
        number: usize,
        /// Its permittivity.
        eps: Complex,
    },
    /// An exponent out of range.
    #[error(
        "Birchak's exponent {exponent} is out of range: it should be between -1 and 1\n\nhint: `crim` is `birchak:0.5`"
    )]
    Exponent {
        /// The exponent given.
        exponent: f64,
    },
    /// A name that is not known.
    #[error(
        "unknown mixing model `{name}`{}\n\nhint: one of crim, looyenga, lichtenecker, birchak:0.4, arithmetic, harmonic, maxwell-garnett, maxwell-garnett-2d-te, bruggeman, bruggeman-2d",
        nearest.map(|n| format!("; did you mean `{n}`?")).unwrap_or_default()
    )]
    UnknownModel {
        /// What was given.
        name: String,
        /// The nearest known name.
        nearest: Option<&'static str>,
    },
    /// The iteration of an implicit rule did not settle.
    #[error("Bruggeman's equation did not settle: the last step was {last_step:e} of the value\n\nhint: use `crim`")]
    NotSettled {
        /// Relative size of the last step.
        last_step: f64,
    },
}

impl std::fmt::Display for MixingModel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (self, NAMES.iter().find(|(_, model)| model == self)) {
            (Self::Birchak(exponent), _) => f.pad(&format!("birchak:{exponent}")),
            (_, Some((name, _))) => f.pad(name),
            (_, None) => f.pad("arithmetic"),
        }
    }
}

impl std::str::FromStr for MixingModel {
    type Err = MixError;
    fn from_str(text: &str) -> Result<Self, MixError> {
        let name = text.trim().to_ascii_lowercase().replace('_', "-");
        if name == "maxwell-garnett-2d-tm" {
            return Ok(Self::Arithmetic);
        }
        if let Some((_, model)) = NAMES.iter().find(|(known, _)| *known == name) {
            return Ok(*model);
        }
        let exponent = name.strip_prefix("birchak:").and_then(|rest| rest.trim().parse::<f64>().ok());
        match exponent {
            Some(exponent) if exponent.abs() <= 1.0 => Ok(Self::Birchak(exponent)),
            Some(exponent) => Err(MixError::Exponent { exponent }),
            None => {
                let nearest = crate::files::nearest_name(&name, NAMES.iter().map(|(known, _)| *known));
                Err(MixError::UnknownModel { name: text.into(), nearest })
            }
        }
    }
}

impl TryFrom<String> for MixingModel {
    type Error = MixError;
    fn try_from(text: String) -> Result<Self, MixError> {
        text.parse()
    }
}

impl From<MixingModel> for String {
    fn from(model: MixingModel) -> Self {
        model.to_string()
    }
}

/// Mixes `parts`, each a share of the volume and a complex relative permittivity `eps' - i eps''`.
///
/// For the two Maxwell Garnett rules the first part is the host; for the others the order does not matter. Complex
/// powers and logarithms take the principal branch, on which passive parts give a passive mixture.
///
/// ```
/// use ballast_gpr::material::{mix, Complex, MixingModel};
/// use ballast_gpr::units::Share;
/// // Clean ballast of the tank: 58 % limestone, 42 % air.
/// let parts = [(Share(0.58), Complex::new(6.5, 0.0)), (Share(0.42), Complex::new(1.0, 0.0))];
/// assert!((mix(MixingModel::Crim, &parts)?.re - 3.605).abs() < 5e-4);
/// # Ok::<(), ballast_gpr::material::MixError>(())
/// ```
///
/// # Errors
/// No parts, shares that are no shares or do not sum to one (within 1e-9), permittivities of an active material, an
/// exponent beyond -1…1.
pub fn mix(model: MixingModel, parts: &[(Share, Complex)]) -> Result<Complex, MixError> {
    check(parts)?;
    Ok(match model {
        MixingModel::Crim => power_mean(0.5, parts),
        MixingModel::Looyenga => power_mean(1.0 / 3.0, parts),
        MixingModel::Lichtenecker => power_mean(0.0, parts),
        MixingModel::Birchak(exponent) if exponent.abs() <= 1.0 => power_mean(exponent, parts),
        MixingModel::Birchak(exponent) => return Err(MixError::Exponent { exponent }),
        MixingModel::Arithmetic => power_mean(1.0, parts),
        MixingModel::Harmonic => power_mean(-1.0, parts),
        MixingModel::MaxwellGarnett => maxwell_garnett(2.0, parts),
        MixingModel::MaxwellGarnett2dTe => maxwell_garnett(1.0, parts),
        MixingModel::Bruggeman => return bruggeman(2.0, parts),
        MixingModel::Bruggeman2d => return bruggeman(1.0, parts),
    })
}

/// Mixes materials at one frequency by [`mix`].
///
/// # Errors
/// As [`mix`].
pub fn mix_dielectrics(
    model: MixingModel,
    parts: &[(Share, &Dielectric)],
    frequency: Hertz,
) -> Result<Complex, MixError> {
    let parts: Vec<_> = parts.iter().map(|(share, part)| (*share, part.permittivity(frequency))).collect();
    mix(model, &parts)
}

fn check(parts: &[(Share, Complex)]) -> Result<(), MixError> {
    if parts.is_empty() {
        return Err(MixError::NoParts);
    }
    for (index, &(share, eps)) in parts.iter().enumerate() {
        if !(0.0..=1.0 + SHARES_TOLERANCE).contains(&share.si()) {
            return Err(MixError::Share { number: index + 1, share });
        }
        if !(eps.re.is_finite() && eps.im.is_finite() && eps.re > 0.0 && eps.im <= 0.0) {
            return Err(MixError::Permittivity { number: index + 1, eps });
        }
    }
    let sum: f64 = parts.iter().map(|(share, _)| share.si()).sum();
    if (sum - 1.0).abs() > SHARES_TOLERANCE { Err(MixError::SharesDoNotSum { sum: Share(sum) }) } else { Ok(()) }
}

/// `(sum f_i eps_i^a)^(1/a)`, and `exp(sum f_i ln eps_i)` for `a = 0`.
fn power_mean(a: f64, parts: &[(Share, Complex)]) -> Complex {
    let sum = |of: &dyn Fn(Complex) -> Complex| {
        parts.iter().fold(Complex::new(0.0, 0.0), |sum, (share, eps)| sum + of(*eps) * share.si())
    };
    if a == 0.0 {
        sum(&|eps| eps.ln()).exp()
    } else if a == 1.0 {
        sum(&|eps| eps)
    } else if a == 0.5 {
        let index = sum(&|eps| eps.sqrt());
        index * index
    } else {
        sum(&|eps| eps.powf(a)).powf(1.0 / a)
    }
}

/// `(e - h)/(e + d h) = sum f_i (e_i - h)/(e_i + d h)`, with `d = 2` for spheres and 1 for cylinders.
fn maxwell_garnett(d: f64, parts: &[(Share, Complex)]) -> Complex {
    let host = parts[0].1;
    let polarised = parts[1..]
        .iter()
        .fold(Complex::new(0.0, 0.0), |sum, (share, eps)| sum + (eps - host) / (eps + host * d) * share.si());
    host * (Complex::new(1.0, 0.0) + polarised * d) / (Complex::new(1.0, 0.0) - polarised)
}

/// Solves `sum f_i (e_i - e)/(e_i + d e) = 0` for `e`.
///
/// Written as `e = sum f_i e_i w_i / sum f_i w_i` with `w_i = 1/(e_i + d e)`, a weighted mean, and iterated from the
/// refractive mean with Steffensen's acceleration, each step of which is kept only while it stays passive.
fn bruggeman(d: f64, parts: &[(Share, Complex)]) -> Result<Complex, MixError> {
    let weighted_mean = |e: Complex| {
        let zero = Complex::new(0.0, 0.0);
        let (above, below) = parts.iter().fold((zero, zero), |(above, below), (share, eps)| {
            let weight = share.si() / (eps + e * d);
            (above + eps * weight, below + weight)
        });
        above / below
    };
    let mut e = power_mean(0.5, parts);
    let mut last_step = f64::INFINITY;
    for _ in 0..1000 {
        let first = weighted_mean(e);
        let second = weighted_mean(first);
        let curvature = second - first * 2.0 + e;
        let jump = if curvature.norm() > 1e-15 * e.norm() { e - (first - e).powi(2) / curvature } else { second };
        let next = if jump.re > 0.0 && jump.im <= 0.0 && jump.re.is_finite() { jump } else { second };
        last_step = (first - e).norm() / e.norm();
        e = next;
        if last_step < 1e-13 {
            return Ok(e);
        }
    }
    if last_step < 1e-9 { Ok(e) } else { Err(MixError::NotSettled { last_step }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn real(parts: &[(f64, f64)]) -> Vec<(Share, Complex)> {
        parts.iter().map(|(share, eps)| (Share(*share), Complex::new(*eps, 0.0))).collect()
    }

    fn crim(parts: &[(f64, f64)]) -> f64 {
        mix(MixingModel::Crim, &real(parts)).unwrap().re
    }

    /// Half of a rounding unit in the digits that the source prints.
    fn prints_as(ours: f64, printed: f64, digits: i32) {
        assert!((ours - printed).abs() <= 0.5 * 10_f64.powi(-digits) + 1e-12, "ours {ours}, printed {printed}");
    }

    /// Stone 6.5, porosity 0.42, water 80.1 in a share S of the voids. The saturated value is a free check against
    /// 26.9 measured by Clark 2001, within 2 %.
    #[test]
    fn crim_of_moist_ballast() {
        let wet = |s: f64| crim(&[(0.58, 6.5), (0.42 * s, 80.1), (0.42 * (1.0 - s), 1.0)]);
        for (s, eps, digits) in
            [(0.0, 3.61, 2), (0.05, 4.27, 2), (0.1, 4.98, 2), (0.2, 6.59, 2), (0.5, 12.7, 1), (1.0, 27.4, 1)]
        {
            prints_as(wet(s), eps, digits);
        }
        assert!((wet(1.0) / 26.9 - 1.0).abs() < 0.02);
    }

    /// The volumetric mixing formula over Table 4 of Benedetto et al. 2017 (ballast, soil, methacrylate, air), with the
    /// methacrylate of the authors and the physical one.
    #[test]
    fn volumetric_mixing_of_the_tank() {
        let expected = [
            (0.0, 0.39, 3.615, 3.498),
            (0.08, 0.31, 4.003, 3.880),
            (0.16, 0.23, 4.410, 4.281),
            (0.24, 0.15, 4.838, 4.702),
        ];
        for (soil, air, authors, physical) in expected {
            prints_as(crim(&[(0.53, 6.5), (soil, 5.03), (0.08, 4.0), (air, 1.0)]), authors, 3);
            prints_as(crim(&[(0.53, 6.5), (soil, 5.03), (0.08, 2.6), (air, 1.0)]), physical, 3);
        }
    }

    /// Layer permittivities in `validation/tank/analytic_tank_arrivals.csv`, which another program computed.
    #[test]
    fn clean_and_fouled_layers_of_the_tank() {
        for (porosity, clean, fouled) in [(0.39, 3.7838, 5.9043), (0.42, 3.605, 5.860)] {
            let digits = if porosity == 0.39 { 4 } else { 3 };
            prints_as(crim(&[(1.0 - porosity, 6.5), (porosity, 1.0)]), clean, digits);
            prints_as(crim(&[(1.0 - porosity, 6.5), (porosity, 5.03)]), fouled, digits);
        }
    }

    /// Facts of the polarisation test: solid share 0.511, stone 6.5: 3.21 (CRIM), 3.81 (arithmetic), 2.20 (2-D TE).
    #[test]
    fn two_dimensional_limits() {
        let parts = real(&[(0.489, 1.0), (0.511, 6.5)]);
        prints_as(mix(MixingModel::Crim, &parts).unwrap().re, 3.21, 2);
        prints_as(mix(MixingModel::Arithmetic, &parts).unwrap().re, 3.81, 2);
        prints_as(mix(MixingModel::MaxwellGarnett2dTe, &parts).unwrap().re, 2.20, 2);
    }

    /// Closed forms. Maxwell Garnett, one inclusion: h [(i+2h) + 2f(i-h)]/[(i+2h) - f(i-h)]. Bruggeman in 2-D at half and
    /// half is the geometric mean (Dykhne 1970); in 3-D with two parts it is the root of a quadratic.
    #[test]
    fn closed_forms() {
        let (h, i, f): (f64, f64, f64) = (1.0, 6.5, 0.58);
        let garnett = h * ((i + 2.0 * h) + 2.0 * f * (i - h)) / ((i + 2.0 * h) - f * (i - h));
        let two = real(&[(1.0 - f, h), (f, i)]);
        assert!((mix(MixingModel::MaxwellGarnett, &two).unwrap().re - garnett).abs() < 1e-12);
        let dykhne = mix(MixingModel::Bruggeman2d, &real(&[(0.5, 2.0), (0.5, 80.1)])).unwrap();
        assert!((dykhne.re - (2.0 * 80.1_f64).sqrt()).abs() < 1e-10 && dykhne.im == 0.0);
        let b = (3.0 * f - 1.0) * i + (3.0 * (1.0 - f) - 1.0) * h;
        let quadratic = (b + (b * b + 8.0 * i * h).sqrt()) / 4.0;
        assert!((mix(MixingModel::Bruggeman, &two).unwrap().re - quadratic).abs() < 1e-10);
        let looyenga = (f * i.cbrt() + (1.0 - f) * h.cbrt()).powi(3);
        assert!((mix(MixingModel::Looyenga, &two).unwrap().re - looyenga).abs() < 1e-12);
        assert!((mix(MixingModel::Lichtenecker, &two).unwrap().re - i.powf(f)).abs() < 1e-12);
    }

    #[test]
    fn names_read_and_write() {
        for text in [
            "crim",
            "looyenga",
            "lichtenecker",
            "arithmetic",
            "harmonic",
            "maxwell-garnett",
            "maxwell-garnett-2d-te",
            "bruggeman",
            "bruggeman-2d",
            "birchak:0.4",
        ] {
            assert_eq!(text.parse::<MixingModel>().unwrap().to_string(), text);
        }
        assert_eq!("maxwell-garnett-2d-tm".parse(), Ok(MixingModel::Arithmetic));
        assert_eq!(serde_json::to_string(&MixingModel::Birchak(0.4)).unwrap(), "\"birchak:0.4\"");
        assert_eq!(
            "crimm".parse::<MixingModel>().unwrap_err().to_string(),
            "unknown mixing model `crimm`; did you mean `crim`?\n\nhint: one of crim, looyenga, lichtenecker, birchak:0.4, arithmetic, harmonic, maxwell-garnett, maxwell-garnett-2d-te, bruggeman, bruggeman-2d"
        );
    }

    #[test]
    fn messages_word_for_word() {
        let message = |parts: &[(f64, f64)]| mix(MixingModel::Crim, &real(parts)).unwrap_err().to_string();
        assert_eq!(message(&[]), "a mixture needs at least one part");
        assert_eq!(
            message(&[(0.5, 6.5), (0.25, 1.0)]),
            "the shares of a mixture should sum to 100%, these sum to 75%\n\nhint: give the rest to `air`"
        );
        assert_eq!(
            message(&[(-0.5, 6.5), (1.5, 1.0)]),
            "share 1 of the mixture is -50%: it should be between 0% and 100%"
        );
        assert_eq!(
            message(&[(0.5, 6.5), (0.5, -1.0)]),
            "permittivity 2 of the mixture is -1+0i: its real part should be above 0 and its imaginary part 0 or below"
        );
        assert_eq!(
            mix(MixingModel::Birchak(2.0), &real(&[(1.0, 1.0)])).unwrap_err().to_string(),
            "Birchak's exponent 2 is out of range: it should be between -1 and 1\n\nhint: `crim` is `birchak:0.5`"
        );
        assert!(mix(MixingModel::Crim, &real(&[(f64::NAN, 1.0)])).is_err());
    }

    const ALL: [MixingModel; 9] = [
        MixingModel::Crim,
        MixingModel::Looyenga,
        MixingModel::Lichtenecker,
        MixingModel::Arithmetic,
        MixingModel::Harmonic,
        MixingModel::MaxwellGarnett,
        MixingModel::MaxwellGarnett2dTe,
        MixingModel::Bruggeman,
        MixingModel::Bruggeman2d,
    ];

    /// Hashin and Shtrikman 1962: Maxwell Garnett with the weaker and with the stronger part as host; `d = 2` for isotropic
    /// mixtures in space, 1 in the plane.
    fn hashin_shtrikman(d: f64, (low, high): (f64, f64), f_high: f64) -> (f64, f64) {
        let bound = |host: f64, other: f64, f: f64| host + f / (1.0 / (other - host) + (1.0 - f) / ((d + 1.0) * host));
        (bound(low, high, f_high), bound(high, low, 1.0 - f_high))
    }

    proptest! {
        /// Wiener: every mixture is between the harmonic and the arithmetic mean.
        #[test]
        fn within_wieners_bounds(f in 0.0..1.0_f64, g in 0.0..1.0_f64, a in 1.0..90.0_f64, b in 1.0..90.0_f64, c in 1.0..90.0_f64) {
            let parts = real(&[(f, a), ((1.0 - f) * g, b), ((1.0 - f) * (1.0 - g), c)]);
            let low = mix(MixingModel::Harmonic, &parts).unwrap().re;
            let high = mix(MixingModel::Arithmetic, &parts).unwrap().re;
            for model in ALL {
                let eps = mix(model, &parts).unwrap().re;
                prop_assert!(eps >= low * (1.0 - 1e-9) && eps <= high * (1.0 + 1e-9), "{model}: {eps} not in {low}..{high}");
            }
        }

        /// Hashin-Shtrikman: the rules derived for isotropic mixtures of two parts keep within the tighter bounds.
        #[test]
        fn within_hashin_and_shtrikmans_bounds(f in 0.01..0.99_f64, low in 1.0..10.0_f64, more in 0.1..80.0_f64) {
            let high = low + more;
            let parts = real(&[(1.0 - f, low), (f, high)]);
            for (model, d) in [(MixingModel::MaxwellGarnett, 2.0), (MixingModel::Bruggeman, 2.0), (MixingModel::MaxwellGarnett2dTe, 1.0), (MixingModel::Bruggeman2d, 1.0)] {
                let (below, above) = hashin_shtrikman(d, (low, high), f);
                let eps = mix(model, &parts).unwrap().re;
                prop_assert!(eps >= below * (1.0 - 1e-9) && eps <= above * (1.0 + 1e-9), "{model}: {eps} not in {below}..{above}");
            }
        }

        /// Passive parts give a passive mixture, and a mixture of one material with itself is that material.
        #[test]
        fn passive_stays_passive(f in 0.0..1.0_f64, a in 1.0..90.0_f64, b in 1.0..90.0_f64, loss_a in 0.0..50.0_f64, loss_b in 0.0..50.0_f64) {
            let (first, second) = (Complex::new(a, -loss_a), Complex::new(b, -loss_b));
            for model in ALL {
                let eps = mix(model, &[(Share(f), first), (Share(1.0 - f), second)]).unwrap();
                prop_assert!(eps.re > 0.0 && eps.im <= 1e-9 * eps.norm(), "{model}: {eps}");
                let same = mix(model, &[(Share(f), first), (Share(1.0 - f), first)]).unwrap();
                prop_assert!((same - first).norm() <= 1e-9 * first.norm(), "{model}: {same} for {first}");
            }
        }
    }
}
