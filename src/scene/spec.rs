//! The scene file. Every field has a default, so that a file holds only what differs from the tank of Benedetto et al.

use std::collections::BTreeMap;
use std::path::Path;

use crate::files;
use crate::material::{FinesPassing, JudgedBy, MixingModel};
use crate::model::{Order, WaveformKind};
use crate::packing::settle::SettleSpec;
use crate::packing::{ClassReading, Grading, InputRule, PackingError};
use crate::units::{Hertz, Metres, Seconds, Share};

use super::error::SceneError;
use super::fouling::FoulingAmount;
use super::medium::MaterialSpec;

/// Version of the scene file; raised when a field changes its meaning.
pub const FORMAT: u32 = 1;

/// What the user wrote, with every default filled in.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SceneSpec {
    /// Version of this file's format.
    pub format: u32,
    /// A line for people.
    pub title: String,
    /// Seed of everything random.
    pub seed: u64,
    /// The container and what is around it.
    pub tank: TankSpec,
    /// The stones.
    pub packing: PackingSpec,
    /// The fines in the voids; absent for clean ballast.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fouling: Option<FoulingSpec>,
    /// Water.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moisture: Option<MoistureSpec>,
    /// The radar.
    pub antenna: AntennaSpec,
    /// Cells, smoothing and time.
    pub grid: GridSpec,
    /// Materials by name: overrides and additions to the built-in ones.
    pub materials: BTreeMap<String, MaterialSpec>,
}

/// The container. Defaults: Benedetto et al. 2017 (Constr. Build. Mater. 140), the tank of the 2018 paper.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TankSpec {
    /// Inner width.
    pub width: Metres,
    /// Inner depth, across the section; as the width when absent. Only a bed of spheres has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth: Option<Metres>,
    /// Height of the ballast bed.
    pub height: Metres,
    /// Thickness of the side walls.
    pub wall: Metres,
    /// Thickness of the base plate. Assumed: the sources leave 0.04 to 0.07 m open.
    pub base: Metres,
    /// Material of walls and base.
    pub wall_material: String,
    /// Air between the walls and the absorbing boundary, and above the antenna. Assumed.
    pub margin: Metres,
    /// Whether a metal plate lies below the tank.
    pub metal_plate: bool,
    /// Whether the bed goes on beyond the tank as a mixture without stones, as far as the model reaches, in place of walls and
    /// air: a piece that is narrower than what the antenna lights then shows no sides.
    #[serde(skip_serializing_if = "is_off")]
    pub embedded: bool,
}

const fn is_off(embedded: &bool) -> bool {
    !*embedded
}

impl Default for TankSpec {
    fn default() -> Self {
        Self {
            width: Metres(1.47),
            depth: None,
            height: Metres(0.48),
            wall: Metres(0.04),
            base: Metres(0.04),
            wall_material: "methacrylate".into(),
            margin: Metres(0.10),
            metal_plate: true,
            embedded: false,
        }
    }
}

/// How the bed comes about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PackingMethod {
    /// Random sequential adsorption and compaction, Benedetto et al. 2018.
    Rsa,
    /// No stones: each layer holds the effective permittivity of its mixture.
    Homogeneous,
    /// Discs or spheres read from `packing.file`.
    File,
    /// Spheres that fell into the tank and came to rest.
    Dem,
    /// Spheres at random places in space, none touching another: a loose bed, under 38 % solid.
    RandomAddition,
}

impl PackingMethod {
    /// The word for it in a scene.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rsa => "rsa",
            Self::Homogeneous => "homogeneous",
            Self::File => "file",
            Self::Dem => "dem",
            Self::RandomAddition => "random-addition",
        }
    }
}

/// Whether the stones carry their true permittivity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EquivalentStone {
    /// The rock's own permittivity: what a 2-D section of this bed would do. The bulk reads high (see the crate docs).
    True,
    /// The permittivity with which the 2-D bed delays a wave as the 3-D mixture would.
    #[serde(rename = "equivalent-2d")]
    Equivalent2d,
}

/// A sieve curve in a scene file.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub enum GradingSpec {
    /// The name of a built-in curve.
    Named(String),
    /// The curve itself.
    Curve(Grading),
}

impl<'de> serde::Deserialize<'de> for GradingSpec {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Grading::deserialize(deserializer).map(Self::Curve)
    }
}

impl GradingSpec {
    /// The curve.
    ///
    /// # Errors
    /// When there is no built-in curve of that name.
    pub fn curve(&self) -> Result<Grading, PackingError> {
        match self {
            Self::Named(name) => Ok(Grading::named(name)?),
            Self::Curve(curve) => Ok(curve.clone()),
        }
    }
}

/// The stones.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PackingSpec {
    /// How the bed comes about.
    pub method: PackingMethod,
    /// Void share of the bed.
    pub voids: Share,
    /// Sieve curve: a built-in name, or the curve itself.
    pub grading: GradingSpec,
    /// Which sizes a retained fraction fills.
    pub class_reading: ClassReading,
    /// Height and solid share that the adsorption starts from.
    pub input: InputRule,
    /// Height of the compaction strips.
    pub strip: Metres,
    /// Share of the box that random addition fills with stone, 30 % when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub solid_share: Option<Share>,
    /// How spheres settle, for `method = "dem"`; kept with a bed that was settled so.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dem: Option<SettleSpec>,
    /// Where a section cuts a bed of spheres, from its front; the middle when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slice: Option<Metres>,
    /// Packing to read, for `method = "file"`: CSV (`x,y,radius`, of spheres `x,y,z,radius`, in metres) or JSON.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<std::path::PathBuf>,
    /// Material of the stones.
    pub stone: String,
    /// Whether the stones carry their true permittivity.
    pub stone_permittivity: EquivalentStone,
    /// How travel times will be judged (used by the equivalent permittivity only).
    pub judged_by: JudgedBy,
    /// Mixing rule for bulk permittivities.
    pub mixing: MixingModel,
}

impl Default for PackingSpec {
    fn default() -> Self {
        Self {
            method: PackingMethod::Rsa,
            voids: Share(0.42),
            grading: GradingSpec::Named("benedetto2018".into()),
            class_reading: ClassReading::default(),
            input: InputRule::default(),
            strip: Metres(0.02),
            solid_share: None,
            dem: None,
            slice: None,
            file: None,
            stone: "limestone".into(),
            stone_permittivity: EquivalentStone::True,
            judged_by: JudgedBy::Phase,
            mixing: MixingModel::Crim,
        }
    }
}

/// The fines in the voids.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FoulingSpec {
    /// How much: `"20cm"` from the bottom, `"40% of voids"`, `"16% by volume"`, `"14% by mass"`.
    pub amount: FoulingAmount,
    /// Material of the fines.
    #[serde(default = "silt")]
    pub material: String,
    /// Share of the voids of the fouled zone that the fines fill.
    #[serde(default = "all")]
    pub filling: Share,
    /// Porosity of the fines, for masses only. Assumed: not published.
    #[serde(default = "porosity_of_fines")]
    pub porosity: Share,
    /// Shares of the fines that pass 4.75 and 0.075 mm, for Selig's index. Default: the tank's silt.
    #[serde(default = "passing_of_silt")]
    pub passing: FinesPassing,
}

impl FoulingSpec {
    /// Fines of the tank's silt, filling the voids of the fouled zone.
    pub fn of(amount: FoulingAmount) -> Self {
        Self { amount, material: silt(), filling: all(), porosity: porosity_of_fines(), passing: passing_of_silt() }
    }
}

fn silt() -> String {
    "silt".into()
}
const fn all() -> Share {
    Share(1.0)
}
const fn porosity_of_fines() -> Share {
    Share(0.36)
}

const fn passing_of_silt() -> FinesPassing {
    FinesPassing::A4_SILT
}

/// Water in the bed.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MoistureSpec {
    /// Water added to the fines, as a share of their volume; it takes the place of air in their pores.
    pub fines: Share,
    /// Water in the voids that hold no fines, as a share of those voids.
    pub voids: Share,
}

/// The radar.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AntennaSpec {
    /// Centre frequency.
    pub frequency: Hertz,
    /// Pulse.
    pub waveform: WaveformKind,
    /// File of a pulse that is used in place of `waveform`: a line `time NAME`, then times in seconds and amplitudes, as
    /// `pulse from-plate` writes it and gprMax's `#excitation_file` reads it. `frequency` stays the nominal one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pulse: Option<std::path::PathBuf>,
    /// Height above the bed's nominal surface.
    pub height: Metres,
    /// Distance between source and receiver. Assumed: not published; small, so that echoes come at normal incidence.
    pub separation: Metres,
    /// Position along the tank, from its left inner wall; the middle when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position: Option<Metres>,
}

impl Default for AntennaSpec {
    fn default() -> Self {
        Self {
            frequency: Hertz(1e9),
            waveform: WaveformKind::Ricker,
            pulse: None,
            height: Metres(0.40),
            separation: Metres(0.04),
            position: None,
        }
    }
}

/// How discs become cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GeometryKind {
    /// A block of cells: true centres, read by gprMax through `#geometry_objects_read`.
    Voxels,
    /// `#cylinder` lines: centres snap to the grid, the file can be read and edited.
    Cylinders,
}

/// What happens where two materials meet in one cell or on one edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Smoothing {
    /// Nothing: a staircase.
    None,
    /// Each edge takes the mean of its four cells (gprMax's default).
    Edges,
    /// Each cell takes the mean over its area, in 32 steps, and each edge the mean of its cells.
    Area,
    /// Each edge takes the mean over its own square from the true discs (built-in solver only; stones as `#cylinder` lines).
    Shapes,
    /// As `Shapes`, and in space the axes are coupled on surfaces that lie aslant, for errors of second order.
    Tensors,
}

impl Smoothing {
    /// The word for it in a scene.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Edges => "edges",
            Self::Area => "area",
            Self::Shapes => "shapes",
            Self::Tensors => "tensors",
        }
    }
}

/// In how many dimensions the waves travel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(into = "u8", try_from = "u8")]
pub enum Dimension {
    /// A section: TMz, the antenna a line across it.
    #[default]
    Two,
    /// Space: the antenna a point.
    Three,
}

impl From<Dimension> for u8 {
    fn from(dimension: Dimension) -> Self {
        match dimension {
            Dimension::Two => 2,
            Dimension::Three => 3,
        }
    }
}

impl TryFrom<u8> for Dimension {
    type Error = String;
    fn try_from(number: u8) -> Result<Self, String> {
        match number {
            2 => Ok(Self::Two),
            3 => Ok(Self::Three),
            _ => Err(format!("{number} is no dimension of a model\n\nhint: write `dimension = 2` or `dimension = 3`")),
        }
    }
}

impl std::str::FromStr for Dimension {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "2" => Ok(Self::Two),
            "3" => Ok(Self::Three),
            _ => Err(format!("`{text}` is no dimension of a model: write 2 or 3")),
        }
    }
}

/// Cells, smoothing and time.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct GridSpec {
    /// In how many dimensions the waves travel.
    #[serde(skip_serializing_if = "is_plane")]
    pub dimension: Dimension,
    /// Cell size. Assumed: not published.
    pub cell: Metres,
    /// Time window.
    pub time_window: Seconds,
    /// Absorbing cells on the open sides.
    pub absorbing_cells: usize,
    /// How discs become cells.
    pub geometry: GeometryKind,
    /// What happens where two materials meet.
    pub smoothing: Smoothing,
    /// Order of the differences in space: 2, as gprMax, or 4.
    #[serde(skip_serializing_if = "is_second")]
    pub order: Order,
}

fn is_plane(dimension: &Dimension) -> bool {
    *dimension == Dimension::Two
}

fn is_second(order: &Order) -> bool {
    *order == Order::Second
}

impl Default for GridSpec {
    fn default() -> Self {
        Self {
            dimension: Dimension::Two,
            cell: Metres(0.002),
            time_window: Seconds(25e-9),
            absorbing_cells: 10,
            geometry: GeometryKind::Voxels,
            smoothing: Smoothing::Edges,
            order: Order::Second,
        }
    }
}

impl Default for SceneSpec {
    fn default() -> Self {
        Self {
            format: FORMAT,
            title: "Roma Tre ballast tank".into(),
            seed: 1,
            tank: TankSpec::default(),
            packing: PackingSpec::default(),
            fouling: None,
            moisture: None,
            antenna: AntennaSpec::default(),
            grid: GridSpec::default(),
            materials: BTreeMap::new(),
        }
    }
}

impl TankSpec {
    /// Inner depth: what the scene says, else as much as the width.
    pub fn inner_depth(&self) -> Metres {
        self.depth.unwrap_or(self.width)
    }
}

impl SceneSpec {
    /// Names of the built-in scenes.
    pub const PRESETS: [&str; 2] = ["tank", "bed"];

    /// A built-in scene by its name.
    ///
    /// # Errors
    /// When there is none of that name.
    pub fn preset(name: &str) -> Result<Self, SceneError> {
        match name {
            "tank" => Ok(Self::default()),
            "bed" => Ok(Self::bed()),
            _ => Err(SceneError::UnknownPreset { name: name.into(), known: Self::PRESETS.join(", ") }),
        }
    }

    /// A piece of the tank small enough to be simulated in space within minutes: 50 x 30 x 48 cm of settled spheres. Beyond it
    /// the bed goes on as a mixture: the antenna, 20 cm above, lights more than the piece, and walls would guide the waves.
    fn bed() -> Self {
        let mut spec = Self { title: "Piece of the ballast tank".into(), ..Self::default() };
        (spec.tank.width, spec.tank.depth) = (Metres(0.5), Some(Metres(0.3)));
        (spec.tank.wall, spec.tank.margin, spec.tank.embedded) = (Metres(0.0), Metres(0.10), true);
        (spec.packing.method, spec.packing.dem) = (PackingMethod::Dem, Some(SettleSpec::default()));
        spec.antenna.height = Metres(0.2);
        (spec.grid.cell, spec.grid.time_window) = (Metres(0.005), Seconds(13e-9));
        (spec.grid.dimension, spec.grid.smoothing) = (Dimension::Three, Smoothing::Shapes);
        spec
    }

    /// Reads a scene from TOML text; `origin` names it in messages.
    ///
    /// # Errors
    /// With the line, and for an unknown key the nearest known one.
    pub fn from_toml(text: &str, origin: &Path) -> Result<Self, SceneError> {
        let spec: Self = toml::from_str(text).map_err(|error| SceneError::toml(origin, text, &error))?;
        if spec.format != FORMAT {
            return Err(SceneError::Format { file: origin.into(), found: spec.format, known: FORMAT });
        }
        Ok(spec)
    }

    /// Reads a scene file; a relative `packing.file` or `antenna.pulse` counts from the scene file's folder.
    ///
    /// # Errors
    /// When it cannot be read, or see [`from_toml`](Self::from_toml).
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let mut spec = Self::from_toml(&files::read_text(path)?, path)?;
        for file in [&mut spec.packing.file, &mut spec.antenna.pulse].into_iter().flatten() {
            if let (true, Some(folder)) = (file.is_relative(), path.parent()) {
                *file = folder.join(&*file);
            }
        }
        Ok(spec)
    }

    /// The scene as TOML, with a comment on every value that is assumed rather than published.
    ///
    /// # Errors
    /// When the scene cannot be expressed in TOML.
    pub fn to_toml(&self) -> Result<String, SceneError> {
        let plain = toml::to_string(self).map_err(|source| SceneError::Serialise(source.to_string()))?;
        Ok(annotate(&plain))
    }
}

/// Values that no source gives, by table and key, with what to say.
const ASSUMED: &[(&str, &str, &str)] = &[
    ("tank", "base", "assumed: the sources leave 0.04 to 0.07 m open"),
    ("tank", "margin", "assumed: air around the tank"),
    ("antenna", "separation", "assumed: not published"),
    ("antenna", "waveform", "assumed: not published"),
    ("grid", "cell", "assumed: not published"),
    ("grid", "absorbing_cells", "assumed: gprMax's default"),
    ("fouling", "porosity", "assumed: not published; enters masses only"),
    ("packing.dem", "young", "assumed: softened; the paper has 17.7 GPa"),
    ("packing.dem", "time_step", "assumed: share of the Rayleigh time"),
    ("packing.dem", "column", "assumed: solid share of the column that falls"),
    ("packing.dem", "energy_ratio", "assumed: what counts as rest"),
    ("packing.dem", "unbalanced_ratio", "assumed: what counts as rest"),
    ("packing.dem", "longest", "assumed: longest simulated time of a stage"),
];

fn annotate(toml: &str) -> String {
    let mut table = String::new();
    let mut out = String::from(
        "# A scene of ballast-gpr: `ballast-gpr build THIS_FILE` makes it again.\n\
         # Values marked \"assumed\" are not in the publications the scene follows.\n",
    );
    for line in toml.lines() {
        if let Some(name) = line.strip_prefix('[') {
            table = name.trim_end_matches(']').to_string();
        }
        let key = line.split('=').next().unwrap_or("").trim();
        match ASSUMED.iter().find(|(t, k, _)| *t == table && *k == key) {
            Some((_, _, note)) => out.push_str(&format!("{line} # {note}\n")),
            None => out.push_str(&format!("{line}\n")),
        }
    }
    out
}
