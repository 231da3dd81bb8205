//! A plane of the grid across x with everything that acts on it, and its step.

use std::ops::Range;

use super::super::instructions::InstructionSet;
use super::super::slab::Slab;
use super::super::state::{Numbers, State};
use super::absorbing::{Absorbing, Columns, Profiles, profiles};
use super::arena::Arena;
use super::couple::Couples;
use super::drive::{Act, Drive};
use super::fields::Fields;
use super::grades::{Grades, Table};
use super::poles::{Dispersion, Poles, poles};
use super::reach::Cones;
use super::setup::{Active, Setup3};
use super::sheet::{LANES, Sheets, padded};
use super::vector::Number;

/// A plane of the grid across x; see `sheet` for what lies where.
pub struct Plane<T> {
    pub i: usize,
    /// Scaled E and H.
    pub fields: Fields<T>,
    pub grades: Option<Grades<T>>,
    /// `da`, then `db` of Hx, Hy, Hz, where anything is magnetic.
    pub magnetic: Option<Sheets<T>>,
    pub absorbing: Option<Absorbing<T>>,
    /// Sources that act on H, sorted by row.
    pub magnets: Vec<PlaneDrive<T>>,
    /// Sources that act on E, sorted by row, then in the order in which they act.
    pub drives: Vec<PlaneDrive<T>>,
    pub dispersion: Option<Dispersion<T>>,
    /// What couples the axes on surfaces.
    pub couples: Option<Couples<T>>,
    pub probes: Vec<Probe>,
}

/// A source within a plane: a table of what it does at each step, and no state of its own.
pub struct PlaneDrive<T> {
    act: Act,
    j: usize,
    axis: usize,
    k: usize,
    /// What is taken from the field, or what E is set to, per step.
    series: Vec<T>,
    /// Steps at which it acts.
    on: Range<usize>,
    /// What E is set to before the first step.
    initial: Option<T>,
}

impl<T: Number> PlaneDrive<T> {
    fn new(drive: &Drive) -> Self {
        let Drive { act, axis, node: [_, j, k], on, .. } = drive.clone();
        let series = drive.series.iter().map(|&v| T::of(v)).collect();
        Self { act, j, axis, k, series, on, initial: drive.initial.map(T::of) }
    }

    /// Acts on the row that it lies in.
    #[inline(always)]
    fn act(&self, step: usize, fields: &mut Fields<T>) {
        if !self.on.contains(&step) {
            return;
        }
        let field = if self.act == Act::TakeH { 3 + self.axis } else { self.axis };
        let field = fields.value_mut(field, self.j, self.k);
        *field = if self.act == Act::SetE { self.series[step] } else { *field - self.series[step] };
    }
}

/// Lets those of a plane's sources act that lie within some nodes of row `j`.
#[inline(always)]
pub fn drive_row<T: Number>(
    drives: &[PlaneDrive<T>],
    j: usize,
    nodes: Range<usize>,
    step: usize,
    fields: &mut Fields<T>,
) {
    let first = drives.partition_point(|drive| drive.j < j);
    for drive in drives[first..].iter().take_while(|drive| drive.j == j) {
        if nodes.contains(&drive.k) {
            drive.act(step, fields);
        }
    }
}

/// A receiver within a plane, and what it has recorded.
pub struct Probe {
    /// Place in the model's list of receivers.
    pub receiver: usize,
    j: usize,
    k: usize,
    /// Ex, Ey, Ez, Hx, Hy, Hz, one sample per step, still scaled.
    pub samples: [Vec<f64>; 6],
}

/// What all planes share.
pub struct Shared<T> {
    pub set: InstructionSet,
    pub width: usize,
    pub active: Active,
    pub ratio: [T; 3],
    pub table: Option<Table<T>>,
    /// Profiles of the rows within the slabs across y.
    pub y: Vec<Option<(usize, Profiles<T>)>>,
    /// The ends of the rows that lie within the slabs across z.
    pub z: Columns<T>,
    pub poles: Poles<T>,
    /// What need not be stepped.
    pub cones: Cones,
    /// Whether the absorbing boundary is of second order.
    pub twice: bool,
    /// A row of ones: the scale of H where nothing is magnetic.
    pub ones: Vec<T>,
    /// Ones at the nodes of a row's last vector that lie within the grid, zeros beyond.
    pub inside: [T; LANES],
}

impl<T: Number> State for Plane<T> {
    fn visit(&mut self, visitor: &mut dyn FnMut(Numbers<'_>)) {
        let Self {
            i: _,
            fields,
            grades: _,
            magnetic: _,
            absorbing,
            magnets: _,
            drives: _,
            dispersion,
            couples: _,
            probes,
        } = self;
        fields.visit(visitor);
        absorbing.visit(visitor);
        dispersion.visit(visitor);
        probes.visit(visitor);
    }
}

impl State for Probe {
    fn visit(&mut self, visitor: &mut dyn FnMut(Numbers<'_>)) {
        let Self { receiver: _, j: _, k: _, samples } = self;
        samples.iter_mut().for_each(|samples| visitor(Numbers::Double(samples)));
    }
}

impl<T: Number> Shared<T> {
    /// Settles what all planes share; `skip`: leaves out what no wave has reached or no receiver will see.
    pub fn new(setup: &Setup3<'_>, set: InstructionSet, skip: bool) -> Self {
        let cells = setup.painted.cells;
        let (low, high) = (setup.slabs[1].extent(), setup.slabs[4].cells);
        let slot = |j: usize| if j < low { j } else { low + (j + high).saturating_sub(cells[1]) };
        Self {
            set,
            width: padded(cells[2]),
            active: setup.active.clone(),
            ratio: std::array::from_fn(|axis| T::of(setup.ratio(axis))),
            table: Table::new(setup),
            y: (0..cells[1]).map(|j| Some((slot(j), profiles(setup, 1, j)?))).collect(),
            z: Columns::new(setup),
            poles: poles(setup),
            cones: Cones::new(setup, skip),
            twice: setup.slabs.iter().any(Slab::is_second_order),
            ones: vec![T::of(1.0); padded(cells[2])],
            inside: std::array::from_fn(|lane| {
                T::of(if lane + padded(cells[2]) < cells[2] + LANES { 1.0 } else { 0.0 })
            }),
        }
    }

    /// Which vector instructions are used.
    pub fn set(&self) -> InstructionSet {
        self.set
    }
}

/// Room for one row of each kind, one per thread.
pub struct Scratch<T> {
    /// What takes the curl, along x, y, z.
    pub scale: [Vec<T>; 3],
    /// E before its step, along x, y, z.
    pub old: [Vec<T>; 3],
}

impl<T: Number> Scratch<T> {
    /// Room for the rows of a model.
    pub fn new(shared: &Shared<T>) -> Self {
        let rows = || std::array::from_fn(|_| vec![T::default(); shared.width]);
        Self { scale: rows(), old: rows() }
    }
}

impl<T: Number> Plane<T> {
    /// A plane beyond the outer wall: zeros that stay.
    pub fn beyond(setup: &Setup3<'_>, arena: &mut Arena) -> Self {
        let [_, ny, nz] = setup.painted.cells;
        Self {
            i: usize::MAX,
            fields: Fields::zeros(arena, ny, padded(nz)),
            grades: None,
            magnetic: None,
            absorbing: None,
            magnets: vec![],
            drives: vec![],
            dispersion: None,
            couples: None,
            probes: vec![],
        }
    }

    /// Reads what lies on plane `i`; the fields come with [`Plane::add_fields`], when the painting may have been freed.
    pub fn new(setup: &Setup3<'_>, shared: &Shared<T>, i: usize) -> Self {
        let [_, ny, nz] = setup.painted.cells;
        let here = setup.drives.iter().filter(|drive| drive.node[0] == i);
        let (mut magnets, mut drives): (Vec<_>, Vec<_>) =
            here.map(PlaneDrive::new).partition(|drive| drive.act == Act::TakeH);
        magnets.sort_by_key(|drive| drive.j);
        drives.sort_by_key(|drive| drive.j);
        let probes = setup.receivers.iter().enumerate().filter(|(_, node)| node[0] == i);
        let probe = |(receiver, node): (usize, &[usize; 3])| Probe {
            receiver,
            j: node[1],
            k: node[2],
            samples: std::array::from_fn(|_| vec![0.0; setup.iterations]),
        };
        let faces = || {
            let mut sheets = Sheets::zeros(6, ny - 1, shared.width);
            for (j, of, axis) in (0..ny).flat_map(|j| (0..6).map(move |part| (j, part / 3, part % 3))) {
                let first = setup.painted.node([i, j, 0]);
                for (k, value) in sheets.at_mut(3 * of + axis, j, 0, nz).iter_mut().enumerate() {
                    *value = T::of(setup.faces[setup.painted.faces[axis].get(first + k) as usize][of]);
                }
            }
            sheets
        };
        Self {
            i,
            grades: Some(Grades::new(setup, i, shared.table.is_some())),
            fields: Fields::none(),
            magnetic: setup.magnetic().then(faces),
            absorbing: None,
            magnets,
            drives,
            dispersion: Dispersion::new(setup, i),
            couples: Couples::new(setup, i),
            probes: probes.map(probe).collect(),
        }
    }

    /// Allocates the fields and the absorbing memory of the plane.
    pub fn add_fields(self, setup: &Setup3<'_>, shared: &Shared<T>, arena: &mut Arena) -> Self {
        let absorbing = Some(Absorbing::new(setup, arena, self.i, shared.width, &shared.z));
        let mut fields = Self::beyond(setup, arena).fields;
        for drive in &self.drives {
            if let Some(initial) = drive.initial {
                *fields.value_mut(drive.axis, drive.j, drive.k) = initial;
            }
        }
        Self { fields, absorbing, ..self }
    }

    /// Takes the samples of the receivers in some rows before step `number`; the first that is beyond `limit`, as axis and `(j, k)`.
    pub fn record(&mut self, number: usize, rows: &Range<usize>, limit: T) -> Option<(usize, [usize; 2])> {
        let mut found = None;
        // Beyond the last node of a row lies the wall, where all is zero: so are the samples to begin with.
        let on_row = |probe: &&mut Probe| rows.contains(&probe.j) && probe.k < self.fields.width();
        for probe in self.probes.iter_mut().filter(on_row) {
            for (field, samples) in probe.samples.iter_mut().enumerate() {
                let value = self.fields.at(field, probe.j, probe.k, 1)[0];
                samples[number] = value.double();
                if field < 3 && value.is_beyond(limit) {
                    found = Some((field, [probe.j, probe.k]));
                }
            }
        }
        found
    }

    /// `count` scaled values of one of Ex, Ey, Ez, Hx, Hy, Hz in row `j`, from node 0 on.
    pub fn row(&self, field: usize, j: usize, count: usize) -> &[T] {
        self.fields.at(field, j, 0, count)
    }

    /// The first edge whose scaled E is not a number or larger than `limit`, as axis and `(j, k)`.
    pub fn find_beyond(&self, shared: &Shared<T>, rows: &Range<usize>, limit: T) -> Option<(usize, [usize; 2])> {
        (0..3).find_map(|axis| {
            rows.clone().find_map(|j| {
                let row = self.fields.at(axis, j, 0, shared.width);
                Some((axis, [j, row.iter().position(|v| v.is_beyond(limit))?]))
            })
        })
    }
}
