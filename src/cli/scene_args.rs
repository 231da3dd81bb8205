//! The flags that describe a scene, and how they change a scene file.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::cli::error::CliError;
use crate::cli::folder;
use crate::model::Order;
use crate::packing::{ClassReading, Grading, PackingError};
use crate::scene::{
    Dimension, EquivalentStone, FoulingAmount, FoulingSpec, GeometryKind, GradingSpec, PackingMethod, SceneSpec,
    Smoothing,
};
use crate::units::{Hertz, Metres, Pascals, Seconds, Share};

/// What a scene is made of. Everything here can stand in the scene file as well; a flag wins over the file.
#[derive(Debug, Clone, Default, PartialEq, Args)]
#[command(next_help_heading = "Scene")]
pub struct SceneArgs {
    /// Built-in scene to start from: `tank` is the laboratory tank of Benedetto et al. 2018, `bed` a small piece of it with
    /// settled spheres, for models in space.
    #[arg(long, value_name = "NAME")]
    pub preset: Option<String>,
    /// Fouling: a height from the bottom (20cm), "40% of voids", "16% by volume" or "14% by mass".
    #[arg(long, value_name = "AMOUNT", allow_hyphen_values = true)]
    pub fouling: Option<FoulingAmount>,
    /// Water added to the fines, share of their volume (5%).
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true)]
    pub moisture: Option<Share>,
    /// Void share of the bed (42%).
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true)]
    pub voids: Option<Share>,
    /// Sieve curve: a name (benedetto2018, en13450-a, arema-4a, ...) or a CSV file `sieve_mm,passing_percent`.
    #[arg(long, value_name = "NAME|FILE")]
    pub grading: Option<String>,
    /// Which sizes a retained fraction fills: `en-933-1` (between its sieve and the next larger one) or `one-sieve-up`.
    #[arg(long, value_name = "READING")]
    pub class_reading: Option<String>,
    /// How the stones come about: `rsa` (discs, Benedetto et al. 2018), `dem` (spheres that fall into the tank and come to rest)
    /// or `random-addition` (loose spheres in space); or a file with stones: CSV `x,y,radius` or `x,y,z,radius` in metres, or JSON written by `pack`.
    #[arg(long, visible_alias = "method", value_name = "METHOD|FILE")]
    pub packing: Option<PathBuf>,
    /// Inner length, depth and height of the tank: 1.5x1.5x0.5m.
    #[arg(long = "box", value_name = "LxDxH")]
    pub box_size: Option<BoxSize>,
    /// Height of the bed.
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub height: Option<Metres>,
    /// dem: number of stones [default: as many as the bed's height takes].
    #[arg(long, value_name = "NUM")]
    pub stones: Option<NonZeroUsize>,
    /// dem: modulus of Young of the stones; soft ones take longer steps and overlap deeper [default: 1 GPa].
    #[arg(long, value_name = "STRESS", allow_hyphen_values = true)]
    pub young: Option<Pascals>,
    /// Dimensions of the waves: 2 is a section, of a bed of spheres the one at `--slice`; 3 is the whole bed [default: 2].
    #[arg(long, value_name = "2|3")]
    pub dimension: Option<Dimension>,
    /// Where the section cuts a bed of spheres, from its front [default: the middle].
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub slice: Option<Metres>,
    /// No stones: each layer holds the effective permittivity of its mixture.
    #[arg(long, conflicts_with = "packing")]
    pub homogeneous: bool,
    /// Stones carry the permittivity with which a 2-D bed delays a wave as the 3-D mixture would (see `explain`).
    #[arg(long)]
    pub equivalent_2d: bool,
    /// Seed of everything random [default: 1].
    #[arg(long, value_name = "NUM", allow_hyphen_values = true)]
    pub seed: Option<u64>,
    /// Centre frequency of the pulse [default: 1 GHz].
    #[arg(long, value_name = "FREQUENCY", allow_hyphen_values = true)]
    pub frequency: Option<Hertz>,
    /// File of the antenna's pulse, as `pulse from-plate` writes it (a gprMax `#excitation_file`), in place of a formula;
    /// `--frequency` stays the nominal one.
    #[arg(long, visible_alias = "excitation-file", value_name = "FILE")]
    pub pulse: Option<PathBuf>,
    /// Cell size [default: 2 mm].
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub cell: Option<Metres>,
    /// Time window [default: 25 ns].
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    pub time_window: Option<Seconds>,
    /// How stones become cells: true centres in a block of cells, or `#cylinder` lines with centres snapped to the grid.
    #[arg(long, value_enum)]
    pub geometry: Option<Geometry>,
    /// Where materials meet: a staircase, each edge the mean of its four cells, each cell the mean over its area, or each
    /// edge the mean over its own square from the true discs.
    #[arg(long, value_enum)]
    pub smoothing: Option<SmoothingFlag>,
    /// Order of the differences in space: 2, as gprMax [default], or 4 (built-in solver only).
    #[arg(long, value_name = "2|4")]
    pub order: Option<Order>,
}

/// Length, depth and height of a box, written `1.5x1.5x0.5m`: a length without a unit has that of the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoxSize(pub [Metres; 3]);

impl std::str::FromStr for BoxSize {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut lengths = [Metres(0.0); 3];
        let mut unit = "";
        let parts: Vec<&str> = text.split('x').map(str::trim).collect();
        let wrong = || format!("`{text}` is not a box: write length, depth and height as `1.5x1.5x0.5m`");
        if parts.len() != 3 {
            return Err(wrong());
        }
        for (length, part) in lengths.iter_mut().zip(parts).rev() {
            let digits = part.trim_end_matches(|c: char| c.is_alphabetic()).len();
            if digits < part.len() {
                unit = &part[digits..];
            }
            *length = format!("{}{unit}", &part[..digits]).parse().map_err(|_| wrong())?;
        }
        Ok(Self(lengths))
    }
}

/// See [`GeometryKind`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Geometry {
    /// A block of cells with true centres.
    Voxels,
    /// `#cylinder` lines.
    Cylinders,
}

/// See [`Smoothing`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SmoothingFlag {
    /// A staircase.
    None,
    /// Edge means, gprMax's default.
    Edges,
    /// Area means in each cell, then edge means.
    Area,
    /// Each edge the mean over its own square, from the true discs (built-in solver only).
    Shapes,
    /// As `shapes`, and in three dimensions the axes coupled on surfaces that lie aslant, for errors of second
    /// order in steps 5 % shorter; not with `--order 4`.
    Tensors,
}

impl SceneArgs {
    /// The scene of a file (or of the preset) with these flags applied.
    ///
    /// # Errors
    /// When the file, the preset, the grading or a reading cannot be used.
    pub fn spec(&self, file: Option<&std::path::Path>) -> Result<SceneSpec, CliError> {
        let mut spec = match (file, &self.preset) {
            (Some(file), None) => SceneSpec::read(&scene_file(file)?)?,
            (None, preset) => SceneSpec::preset(preset.as_deref().unwrap_or("tank"))?,
            (Some(_), Some(_)) => {
                return Err(CliError::input(
                    "a scene file and `--preset` were both given\n\nhint: leave one of them out",
                ));
            }
        };
        self.apply(&mut spec)?;
        Ok(spec)
    }

    fn apply(&self, spec: &mut SceneSpec) -> Result<(), CliError> {
        if let Some(amount) = &self.fouling {
            match &mut spec.fouling {
                Some(fouling) => fouling.amount = *amount,
                None => spec.fouling = Some(FoulingSpec::of(*amount)),
            }
        }
        if let Some(share) = self.moisture {
            spec.moisture.get_or_insert_default().fines = share;
        }
        if let Some(grading) = &self.grading {
            spec.packing.grading = GradingSpec::Curve(read_grading(grading)?);
        }
        if let Some(reading) = &self.class_reading {
            spec.packing.class_reading = read_reading(reading)?;
        }
        match self.packing.as_deref().map(|path| (path.to_str(), path)) {
            None => {}
            Some((Some("rsa"), _)) => spec.packing.method = PackingMethod::Rsa,
            Some((Some("dem"), _)) => spec.packing.method = PackingMethod::Dem,
            Some((Some("random-addition"), _)) => spec.packing.method = PackingMethod::RandomAddition,
            Some((_, file)) => {
                spec.packing.method = PackingMethod::File;
                spec.packing.file = Some(file.into());
            }
        }
        if let Some(BoxSize([length, depth, height])) = self.box_size {
            (spec.tank.width, spec.tank.depth, spec.tank.height) = (length, Some(depth), height);
        }
        set(&mut spec.tank.height, self.height);
        if spec.packing.method == PackingMethod::Dem || self.stones.is_some() || self.young.is_some() {
            let how = spec.packing.dem.get_or_insert_default();
            set(&mut how.young, self.young);
            if let Some(stones) = self.stones {
                how.stones = Some(stones.get());
            }
        }
        set(&mut spec.grid.dimension, self.dimension);
        if self.slice.is_some() {
            spec.packing.slice = self.slice;
        }
        if self.homogeneous {
            spec.packing.method = PackingMethod::Homogeneous;
        }
        if self.equivalent_2d {
            spec.packing.stone_permittivity = EquivalentStone::Equivalent2d;
        }
        set(&mut spec.packing.voids, self.voids);
        set(&mut spec.seed, self.seed);
        set(&mut spec.antenna.frequency, self.frequency);
        if self.pulse.is_some() {
            spec.antenna.pulse.clone_from(&self.pulse);
        }
        set(&mut spec.grid.cell, self.cell);
        set(&mut spec.grid.time_window, self.time_window);
        set(&mut spec.grid.order, self.order);
        set(
            &mut spec.grid.geometry,
            self.geometry.map(|geometry| match geometry {
                Geometry::Voxels => GeometryKind::Voxels,
                Geometry::Cylinders => GeometryKind::Cylinders,
            }),
        );
        set(
            &mut spec.grid.smoothing,
            self.smoothing.map(|smoothing| match smoothing {
                SmoothingFlag::None => Smoothing::None,
                SmoothingFlag::Edges => Smoothing::Edges,
                SmoothingFlag::Area => Smoothing::Area,
                SmoothingFlag::Shapes => Smoothing::Shapes,
                SmoothingFlag::Tensors => Smoothing::Tensors,
            }),
        );
        Ok(())
    }
}

/// The scene file that a user names: itself, or that of a folder that `build` has written.
fn scene_file(named: &std::path::Path) -> Result<PathBuf, CliError> {
    if !named.is_dir() {
        return Ok(named.into());
    }
    let file = named.join(folder::SCENE);
    if file.is_file() {
        return Ok(file);
    }
    Err(CliError::input(format!(
        "the folder `{}` holds no scene (`{}`)\n\nhint: `ballast-gpr build --out FOLDER` makes a folder with one",
        named.display(),
        folder::SCENE
    )))
}

fn set<T>(place: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *place = value;
    }
}

fn read_grading(text: &str) -> Result<Grading, CliError> {
    let path = std::path::Path::new(text);
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv")) || path.is_file() {
        return Ok(Grading::from_csv(text, &crate::files::read_text(path)?).map_err(PackingError::from)?);
    }
    Ok(Grading::named(text).map_err(PackingError::from)?)
}

fn read_reading(text: &str) -> Result<ClassReading, CliError> {
    match text {
        "en-933-1" => Ok(ClassReading::En933),
        "one-sieve-up" => Ok(ClassReading::OneSieveUp),
        _ => Err(CliError::input(format!(
            "there is no class reading `{text}`\n\nhint: write `--class-reading en-933-1` or `--class-reading one-sieve-up`"
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_is_read_with_one_unit_or_three() {
        let read = |text: &str| text.parse::<BoxSize>();
        assert_eq!(read("1.5x1.5x0.5m"), Ok(BoxSize([Metres(1.5), Metres(1.5), Metres(0.5)])));
        assert_eq!(read("1m x 50cm x 480 mm"), Ok(BoxSize([Metres(1.0), Metres(0.5), Metres(0.48)])));
        for wrong in ["1.5x1.5m", "1x1x1", "axbxcm", ""] {
            let message = format!("`{wrong}` is not a box: write length, depth and height as `1.5x1.5x0.5m`");
            assert_eq!(read(wrong), Err(message));
        }
    }
}
