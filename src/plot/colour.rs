//! Colours that differ for colour-blind eyes, and a colour map whose lightness grows evenly.

/// A colour, 8 bits per channel, with its opacity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Colour {
    /// Red, green and blue.
    pub rgb: [u8; 3],
    /// Opacity: 1 hides what lies below, 0 is invisible.
    pub alpha: f64,
}

impl Colour {
    /// Black.
    pub const BLACK: Self = Self::grey(0);
    /// White.
    pub const WHITE: Self = Self::grey(255);

    /// Makes an opaque colour.
    pub const fn new(red: u8, green: u8, blue: u8) -> Self {
        Self { rgb: [red, green, blue], alpha: 1.0 }
    }

    /// Makes an opaque grey, 0 black to 255 white.
    pub const fn grey(level: u8) -> Self {
        Self::new(level, level, level)
    }

    /// The same colour with another opacity.
    pub const fn with_alpha(self, alpha: f64) -> Self {
        Self { rgb: self.rgb, alpha }
    }

    /// The colour of the palette with this index, counted round.
    pub const fn of_palette(index: usize) -> Self {
        PALETTE[index % PALETTE.len()]
    }
}

/// The qualitative palette of Okabe and Ito (2008), its yellow left out (too light on white), with a grey at the end:
/// blue, vermilion, bluish green, reddish purple, orange, sky blue, black, grey.
pub const PALETTE: [Colour; 8] = [
    Colour::new(0, 114, 178),
    Colour::new(213, 94, 0),
    Colour::new(0, 158, 115),
    Colour::new(204, 121, 167),
    Colour::new(230, 159, 0),
    Colour::new(86, 180, 233),
    Colour::BLACK,
    Colour::grey(128),
];

/// Every sixteenth entry of the viridis map of S. van der Walt and N. Smith (2015; public domain, CC0).
const VIRIDIS: [[u8; 3]; 17] = [
    [68, 1, 84],
    [72, 24, 106],
    [71, 45, 123],
    [66, 64, 134],
    [59, 82, 139],
    [51, 99, 141],
    [44, 114, 142],
    [38, 130, 142],
    [33, 145, 140],
    [31, 159, 136],
    [39, 173, 129],
    [61, 188, 116],
    [92, 200, 99],
    [129, 211, 77],
    [170, 220, 50],
    [213, 226, 26],
    [253, 231, 37],
];

/// The colour of viridis at `share` of its length; outside [0, 1] the nearest end, NaN the dark end.
pub fn viridis(share: f64) -> Colour {
    let steps = (VIRIDIS.len() - 1) as f64;
    let at = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) * steps };
    let low = (at.floor() as usize).min(VIRIDIS.len() - 2);
    let part = at - low as f64;
    let mix = |c: usize| {
        let (a, b) = (f64::from(VIRIDIS[low][c]), f64::from(VIRIDIS[low + 1][c]));
        (a + (b - a) * part).round() as u8
    };
    Colour::new(mix(0), mix(1), mix(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance of Rec. 709 on gamma-coded values: enough to order greys as a printer would.
    fn luma(colour: Colour) -> f64 {
        let [r, g, b] = colour.rgb.map(f64::from);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }

    #[test]
    fn viridis_grows_lighter_all_the_way() {
        for i in 0..255 {
            let (here, next) = (luma(viridis(f64::from(i) / 255.0)), luma(viridis(f64::from(i + 1) / 255.0)));
            assert!(next >= here - 0.8, "darker at {i}: {here} then {next}");
        }
        assert_eq!(viridis(-3.0).rgb, [68, 1, 84]);
        assert_eq!(viridis(7.0).rgb, [253, 231, 37]);
        assert_eq!(viridis(f64::NAN).rgb, [68, 1, 84]);
    }

    /// Entry 128 of the published table of 256 is (33, 145, 140), entry 40 is (69, 55, 129) and entry 200 is
    /// (112, 207, 87). Two levels of tolerance: between its stops this table is interpolated.
    #[test]
    fn viridis_is_the_published_one() {
        for (entry, rgb) in [(128.0, [33, 145, 140]), (40.0, [69, 55, 129]), (200.0, [112, 207, 87])] {
            let ours = viridis(entry / 255.0).rgb;
            for c in 0..3 {
                assert!(ours[c].abs_diff(rgb[c]) <= 2, "entry {entry}: {ours:?}, published {rgb:?}");
            }
        }
    }
}
