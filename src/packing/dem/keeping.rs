//! The state of a simulation in a file, from which another process goes on to the same bits.
//!
//! A file begins with a line of text, `ballast-gpr spheres` and a JSON object with the version of the format, the
//! materials and the walls; behind it are all numbers of the state, little-endian, and eight bytes of checksum.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use super::DemError;
use super::bodies::Body;
use super::law::{Laws, Rolling};
use super::pairs::Pairs;
use super::rebuild::Lost;
use super::setup::{Grain, Motion, Wall, WallShape};
use super::simulation::Simulation;
use super::stuff::{Pairing, Stuff};
use super::tape::{Reader, Tape, Writer};
use super::vector::Four;
use super::wall_contacts::{Slot, WallContacts};
use crate::files::{self, FileError};
use crate::geometry::Sphere;

/// The first words of a file.
const MAGIC: &str = "ballast-gpr spheres ";
/// Version of what follows.
const FORMAT: u32 = 1;
/// Longest first line that is read: a mesh of some million triangles.
const LONGEST_HEADER: u64 = 1 << 28;

/// The first line.
#[derive(serde::Serialize, serde::Deserialize)]
struct Header {
    format: u32,
    program: String,
    stuffs: Vec<Stuff>,
    pairings: Vec<Pairing>,
    friction: bool,
    rolling: Rolling,
    /// Shape, material and presence of each wall.
    walls: Vec<(WallShape, usize, bool)>,
}

impl Simulation {
    /// Writes the whole state, beside its place and then renamed, so that there is always a whole one.
    ///
    /// # Errors
    /// What the system said.
    pub fn save(&self, path: &Path) -> Result<(), DemError> {
        let walls = self.bodies.iter().map(|body| (body.wall.shape.clone(), body.wall.material, body.present));
        let header = Header {
            format: FORMAT,
            program: env!("CARGO_PKG_VERSION").into(),
            stuffs: self.stuffs.clone(),
            pairings: self.pairings.clone(),
            friction: self.friction,
            rolling: self.rolling,
            walls: walls.collect(),
        };
        let mut copy = self.clone();
        files::write_atomically(path, |file| {
            let mut line = MAGIC.as_bytes().to_vec();
            serde_json::to_writer(&mut line, &header)?;
            line.push(b'\n');
            file.write_all(&line)?;
            let mut writer = Writer::new(file);
            copy.pass(&mut writer)?;
            writer.finish()
        })?;
        Ok(())
    }

    /// Reads a state and goes on from it: the steps that follow have the bits they would have had without the break.
    ///
    /// # Errors
    /// When the file cannot be read, is none of [`save`](Self::save) or of another version, or is damaged.
    pub fn load(path: &Path) -> Result<Self, DemError> {
        let not_one = |what: String| DemError::NotAState { path: path.into(), what };
        let file = File::open(path).map_err(FileError::of("read", path))?;
        let mut file = BufReader::new(file);
        let mut line = vec![];
        (&mut file).take(LONGEST_HEADER).read_until(b'\n', &mut line).map_err(FileError::of("read", path))?;
        let json = line
            .strip_prefix(MAGIC.as_bytes())
            .ok_or_else(|| not_one("it is not the state of a simulation of spheres".into()))?;
        let format = serde_json::from_slice::<serde_json::Value>(json)
            .map_err(|error| not_one(format!("its first line is damaged: {error}")))?["format"]
            .as_u64();
        if format != Some(u64::from(FORMAT)) {
            let found = format.map_or("none".into(), |format| format.to_string());
            return Err(not_one(format!("its format is {found}, and this program reads {FORMAT}")));
        }
        let header: Header =
            serde_json::from_slice(json).map_err(|error| not_one(format!("its first line is damaged: {error}")))?;
        let mut made = Self::empty();
        made.laws = Laws::new(&header.stuffs, &header.pairings);
        (made.stuffs, made.pairings) = (header.stuffs, header.pairings);
        (made.friction, made.rolling) = (header.friction, header.rolling);
        made.bodies = header
            .walls
            .into_iter()
            .map(|(shape, material, present)| {
                let mut body = Body::new(Wall { shape, material, motion: Motion::Fixed });
                body.present = present;
                body
            })
            .collect();
        let mut reader = Reader::new(&mut file);
        made.pass(&mut reader)
            .and_then(|()| reader.finish())
            .map_err(|error| not_one(format!("it is damaged: {error}")))?;
        if !made.is_whole() {
            return Err(not_one("it is damaged: its lists do not fit together".into()));
        }
        made.walls.finish_moving(&made.bodies);
        made.note_turns();
        made.fit_mesh_grids(made.radii[1] + made.list.skin);
        Ok(made)
    }

    /// Whether every index of a list lies inside what it points to.
    fn is_whole(&self) -> bool {
        let grains = self.grains.len();
        let fits = |starts: &[u32], owners: usize, held: usize| {
            starts.len() == owners + 1
                && starts[0] == 0
                && starts.windows(2).all(|two| two[0] <= two[1])
                && starts[owners] as usize == held
        };
        let below = |indices: &[u32], limit: usize| indices.iter().all(|&index| (index as usize) < limit);
        let (pairs, walls) = (&self.pairs, &self.walls);
        let near_walls = walls.grain.len();
        let all = [self.grains.place.len(), self.grains.velocity.len(), self.grains.spin.len(), self.list.place.len()];
        all.iter().all(|&len| len == grains)
            && self.grains.material.len() == grains
            && self.grains.material.iter().all(|&material| (material as usize) < self.stuffs.len())
            && below(&self.grains.id, self.count)
            && fits(&pairs.starts, grains, pairs.partner.len())
            && below(&pairs.partner, grains)
            && pairs.touching.len() == pairs.partner.len()
            && pairs.force.len() == pairs.partner.len()
            && walls.wall.len() == near_walls
            && below(&walls.grain, grains)
            && below(&walls.wall, self.bodies.len())
            && fits(&walls.starts, grains, near_walls)
            && fits(&walls.triangle_starts, near_walls, walls.triangles.len())
            && fits(&walls.slot_starts, near_walls, walls.slots.len())
            && walls.force.len() == near_walls
            && walls.torque.len() == near_walls
    }

    /// Passes all numbers of the state to or from a file.
    fn pass(&mut self, tape: &mut dyn Tape) -> io::Result<()> {
        tape.numbers(&mut self.gravity)?;
        self.domain.iter_mut().try_for_each(|corner| tape.numbers(corner))?;
        for ends in &mut self.periodic {
            let mut numbers = ends.map_or([0.0; 3], |[from, to]| [1.0, from, to]);
            tape.numbers(&mut numbers)?;
            *ends = (numbers[0] != 0.0).then_some([numbers[1], numbers[2]]);
        }
        tape.numbers(&mut self.radii)?;
        let (length, limits, watch) = (&mut self.length, &mut self.limits, &mut self.watch);
        for number in [
            &mut length.seconds,
            &mut length.rayleigh,
            &mut length.contact,
            &mut limits.initial_overlap,
            &mut limits.overlap,
            &mut watch.work,
            &mut watch.least,
            &mut watch.most_kinetic,
            &mut watch.most_elastic,
            &mut watch.time_offset,
            &mut self.list.skin,
            &mut self.list.travel,
            &mut self.list.body_travel,
        ] {
            tape.number(number)?;
        }
        for count in [&mut self.step, &mut self.list.made_at] {
            tape.count(count)?;
        }
        for index in [&mut length.grain, &mut self.count] {
            tape.index(index)?;
        }
        let mut keep = u64::from(self.keep_rolling_torque);
        tape.count(&mut keep)?;
        self.keep_rolling_torque = keep != 0;
        for body in &mut self.bodies {
            pass_body(body, tape)?;
        }
        self.pass_grains(tape)?;
        self.pass_pairs(tape)?;
        pass_walls(&mut self.walls, tape)
    }

    fn pass_grains(&mut self, tape: &mut dyn Tape) -> io::Result<()> {
        tape.indices(&mut self.grains.id)?;
        for fours in [
            &mut self.grains.place,
            &mut self.grains.velocity,
            &mut self.grains.spin,
            &mut self.list.place,
            &mut self.rolling_torque,
        ] {
            tape.fours(fours)?;
        }
        let mut materials: Vec<u32> = self.grains.material.iter().map(|&material| u32::from(material)).collect();
        tape.indices(&mut materials)?;
        self.grains.material = materials.into_iter().map(|material| material as u16).collect();
        let mut lost = self.lost.len() as u64;
        tape.count(&mut lost)?;
        let nowhere = Lost { grain: 0, step: 0, grain_then: Grain::at_rest(Sphere { centre: [0.0; 3], radius: 0.0 }) };
        // One by one, so that a damaged count ends with the file and not with the memory.
        for n in 0..lost as usize {
            if self.lost.len() == n {
                self.lost.push(nowhere);
            }
            let Lost { grain, step, grain_then } = &mut self.lost[n];
            tape.index(grain)?;
            tape.count(step)?;
            tape.numbers(&mut grain_then.sphere.centre)?;
            tape.number(&mut grain_then.sphere.radius)?;
            tape.numbers(&mut grain_then.velocity)?;
            tape.numbers(&mut grain_then.spin)?;
            tape.index(&mut grain_then.material)?;
        }
        Ok(())
    }

    fn pass_pairs(&mut self, tape: &mut dyn Tape) -> io::Result<()> {
        let pairs = &mut self.pairs;
        tape.indices(&mut pairs.starts)?;
        tape.indices(&mut pairs.partner)?;
        tape.bytes(&mut pairs.touching)?;
        let (mut history, mut rolling) = (std::mem::take(&mut pairs.history), std::mem::take(&mut pairs.rolling));
        let (mut force, mut moment) = (std::mem::take(&mut pairs.force), std::mem::take(&mut pairs.moment));
        let mut resistance = std::mem::take(&mut pairs.resistance);
        for fours in [&mut history, &mut rolling, &mut force, &mut moment, &mut resistance] {
            tape.fours(fours)?;
        }
        let touching = std::mem::take(&mut pairs.touching);
        let (starts, partner) = (std::mem::take(&mut pairs.starts), std::mem::take(&mut pairs.partner));
        let grains = self.grains.len();
        if starts.len() != grains + 1 || partner.iter().any(|&j| j as usize >= grains) {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "a pair of grains that are not there"));
        }
        // The incoming pairs follow from the others.
        self.pairs = Pairs::new(starts, partner, self.needs());
        self.pairs.touching = touching;
        (self.pairs.history, self.pairs.rolling, self.pairs.force) = (history, rolling, force);
        (self.pairs.moment, self.pairs.resistance) = (moment, resistance);
        self.pairs.fit(self.needs());
        Ok(())
    }
}

fn pass_body(body: &mut Body, tape: &mut dyn Tape) -> io::Result<()> {
    let mut numbers = match body.wall.motion {
        Motion::Fixed => [0.0; 12],
        Motion::Prescribed { velocity: [a, b, c], spin: [d, e, f], about: [g, h, i], from, until } => {
            [1.0, a, b, c, d, e, f, g, h, i, from, until]
        }
        Motion::Free { mass, moves, velocity: [a, b, c], load: [d, e, f] } => {
            let [x, y, z] = moves.map(|moves| if moves { 1.0 } else { 0.0 });
            [2.0, mass, x, y, z, a, b, c, d, e, f, 0.0]
        }
    };
    tape.numbers(&mut numbers)?;
    body.wall.motion = match numbers {
        [1.0, a, b, c, d, e, f, g, h, i, from, until] => {
            Motion::Prescribed { velocity: [a, b, c], spin: [d, e, f], about: [g, h, i], from, until }
        }
        [2.0, mass, x, y, z, a, b, c, d, e, f, _] => {
            Motion::Free { mass, moves: [x, y, z].map(|v| v != 0.0), velocity: [a, b, c], load: [d, e, f] }
        }
        _ => Motion::Fixed,
    };
    let state = &mut body.state;
    for three in [&mut state.displacement, &mut state.about, &mut state.velocity, &mut state.spin] {
        tape.numbers(three)?;
    }
    tape.numbers(&mut state.turned)?;
    tape.number(&mut body.extent)
}

fn pass_walls(walls: &mut WallContacts, tape: &mut dyn Tape) -> io::Result<()> {
    for indices in [
        &mut walls.starts,
        &mut walls.grain,
        &mut walls.wall,
        &mut walls.triangle_starts,
        &mut walls.triangles,
        &mut walls.slot_starts,
    ] {
        tape.indices(indices)?;
    }
    tape.fours(&mut walls.force)?;
    tape.fours(&mut walls.torque)?;
    let mut slots = walls.slots.len() as u64;
    tape.count(&mut slots)?;
    for n in 0..slots as usize {
        if walls.slots.len() == n {
            walls.slots.push(Slot::default());
        }
        let slot = &mut walls.slots[n];
        tape.count(&mut slot.feature)?;
        let mut triangle = u64::from(slot.triangle);
        tape.count(&mut triangle)?;
        slot.triangle = triangle as u32;
        let mut history: [Four; 1] = [slot.history];
        tape.numbers(&mut history[0].0)?;
        slot.history = history[0];
        for three in [&mut slot.rolling, &mut slot.normal, &mut slot.force, &mut slot.point] {
            tape.numbers(three)?;
        }
    }
    Ok(())
}
