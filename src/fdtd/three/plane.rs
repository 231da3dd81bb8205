//! A plane of the grid across x with everything that acts on it, and its step.

use std::ops::Range;

use super::super::dispersion::overlap;
use super::super::instructions::InstructionSet;
use super::super::state::{Numbers, State};
use super::absorbing::{Absorbing, Columns, Profiles, Store, profiles};
use super::drive::{Act, Drive};
use super::grades::{Grades, Lookup, Table};
use super::instructions::Number;
use super::kernel::{
    EdgeRow, absorb_columns, absorb_columns_scaled, absorb_columns_twice, absorb_row, absorb_row_scaled,
    absorb_row_twice, add_curl, add_curl_lossy, add_h, add_h_magnetic,
};
use super::poles::{Dispersion, Poles, poles};
use super::reach::Cones;
use super::setup::{Active, Setup3};
use super::sheet::{Sheet, padded};

/// A plane of the grid across x; see `sheet` for what lies where.
pub struct Plane<T> {
    i: usize,
    /// Scaled E along x, y, z.
    pub e: [Sheet<T>; 3],
    /// Scaled H along x, y, z.
    pub h: [Sheet<T>; 3],
    grades: Option<Grades<T>>,
    /// `da`, `db` of each H component, where anything is magnetic.
    magnetic: Option<Box<[[Sheet<T>; 3]; 2]>>,
    absorbing: Option<Absorbing<T>>,
    /// Sources that act on H, sorted by row.
    magnets: Vec<PlaneDrive<T>>,
    /// Sources that act on E, sorted by row, then in the order in which they act.
    drives: Vec<PlaneDrive<T>>,
    dispersion: Option<Dispersion<T>>,
    pub probes: Vec<Probe>,
}

/// A source within a plane: a table of what it does at each step, and no state of its own.
struct PlaneDrive<T> {
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
    fn act(&self, step: usize, e: &mut [Sheet<T>; 3], h: &mut [Sheet<T>; 3]) {
        if !self.on.contains(&step) {
            return;
        }
        let field = if self.act == Act::TakeH { &mut h[self.axis] } else { &mut e[self.axis] };
        let field = &mut field.at_mut(self.j, self.k, 1)[0];
        *field = if self.act == Act::SetE { self.series[step] } else { *field - self.series[step] };
    }
}

/// Lets those of a plane's sources act that lie within some nodes of row `j`.
#[inline(always)]
fn drive_row<T: Number>(
    drives: &[PlaneDrive<T>],
    j: usize,
    nodes: Range<usize>,
    step: usize,
    e: &mut [Sheet<T>; 3],
    h: &mut [Sheet<T>; 3],
) {
    let first = drives.partition_point(|drive| drive.j < j);
    for drive in drives[first..].iter().take_while(|drive| drive.j == j) {
        if nodes.contains(&drive.k) {
            drive.act(step, e, h);
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
    set: InstructionSet,
    cells: [usize; 3],
    width: usize,
    active: Active,
    ratio: [T; 3],
    table: Option<Table<T>>,
    /// Profiles of the rows within the slabs across y.
    y: Vec<Option<(usize, Profiles<T>)>>,
    z: Vec<Columns<T>>,
    poles: Poles<T>,
    /// What need not be stepped.
    pub cones: Cones,
    /// A row of ones: the scale of H where nothing is magnetic.
    ones: Vec<T>,
}

impl<T: Number> State for Plane<T> {
    fn visit(&mut self, visitor: &mut dyn FnMut(Numbers<'_>)) {
        let Self { i: _, e, h, grades: _, magnetic: _, absorbing, magnets: _, drives: _, dispersion, probes } = self;
        e.visit(visitor);
        h.visit(visitor);
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
            cells,
            width: padded(cells[2]),
            active: setup.active.clone(),
            ratio: std::array::from_fn(|axis| T::of(setup.ratio(axis))),
            table: Table::new(setup),
            y: (0..cells[1]).map(|j| Some((slot(j), profiles(setup, 1, j)?))).collect(),
            z: Columns::both(setup),
            poles: poles(setup),
            cones: Cones::new(setup, skip),
            ones: vec![T::of(1.0); padded(cells[2])],
        }
    }

    /// Which vector instructions are used.
    pub fn set(&self) -> InstructionSet {
        self.set
    }
}

/// Room for one row of each kind, one per thread.
pub struct Scratch<T> {
    lookup: Lookup<T>,
    old: [Vec<T>; 3],
}

impl<T: Number> Scratch<T> {
    /// Room for the rows of a model.
    pub fn new(shared: &Shared<T>) -> Self {
        let old = std::array::from_fn(|_| vec![T::default(); shared.width]);
        Self { lookup: Lookup::new(shared.width), old }
    }
}

impl<T: Number> Plane<T> {
    /// A plane beyond the outer wall: zeros that stay.
    pub fn beyond(setup: &Setup3<'_>) -> Self {
        let [_, ny, nz] = setup.painted.cells;
        let sheets = || std::array::from_fn(|_| Sheet::zeros(ny, padded(nz)));
        Self {
            i: usize::MAX,
            e: sheets(),
            h: sheets(),
            grades: None,
            magnetic: None,
            absorbing: None,
            magnets: vec![],
            drives: vec![],
            dispersion: None,
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
        let faces = |of: usize| -> [Sheet<T>; 3] {
            std::array::from_fn(|axis| {
                let mut sheet = Sheet::zeros(ny - 1, shared.width);
                for j in 0..ny {
                    let first = setup.painted.node([i, j, 0]);
                    for (k, value) in sheet.at_mut(j, 0, nz).iter_mut().enumerate() {
                        *value = T::of(setup.faces[setup.painted.faces[axis].get(first + k) as usize][of]);
                    }
                }
                sheet
            })
        };
        Self {
            i,
            grades: Some(Grades::new(setup, i, shared.table.is_some())),
            e: std::array::from_fn(|_| Sheet::zeros(0, 0)),
            h: std::array::from_fn(|_| Sheet::zeros(0, 0)),
            magnetic: setup.magnetic().then(|| Box::new([faces(0), faces(1)])),
            absorbing: None,
            magnets,
            drives,
            dispersion: Dispersion::new(setup, i),
            probes: probes.map(probe).collect(),
        }
    }

    /// Allocates the fields and the absorbing memory of the plane.
    pub fn add_fields(self, setup: &Setup3<'_>, shared: &Shared<T>) -> Self {
        let absorbing = Some(Absorbing::new(setup, self.i, shared.width, &shared.z));
        let Self { mut e, h, .. } = Self::beyond(setup);
        for drive in &self.drives {
            if let Some(initial) = drive.initial {
                e[drive.axis].at_mut(drive.j, drive.k, 1)[0] = initial;
            }
        }
        Self { e, h, absorbing, ..self }
    }

    /// Takes the receivers' samples before step `number`; the first that is beyond `limit`, as axis and `(j, k)`.
    pub fn record(&mut self, number: usize, limit: T) -> Option<(usize, [usize; 2])> {
        let mut found = None;
        for probe in &mut self.probes {
            for (field, samples) in probe.samples.iter_mut().enumerate() {
                let sheet = if field < 3 { &self.e[field] } else { &self.h[field - 3] };
                let value = sheet.at(probe.j, probe.k, 1)[0];
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
        let sheet = if field < 3 { &self.e[field] } else { &self.h[field - 3] };
        sheet.at(j, 0, count)
    }

    /// The first edge whose scaled E is not a number or larger than `limit`, as axis and `(j, k)`.
    pub fn find_beyond(&self, shared: &Shared<T>, limit: T) -> Option<(usize, [usize; 2])> {
        (0..3).find_map(|axis| {
            (0..shared.cells[1]).find_map(|j| {
                let row = self.e[axis].at(j, 0, shared.width);
                Some((axis, [j, row.iter().position(|v| v.is_beyond(limit))?]))
            })
        })
    }
}

/// A step of one plane: H from E of this plane and the next, then E from H of this plane and the one before.
///
/// Rows may be stepped one after the other in place: H of a row needs E of the row and of the next, which are still those
/// of the step before, and E of a row needs H of the row and the one before, which are stepped already.
pub struct Step<'a, T> {
    pub shared: &'a Shared<T>,
    pub step: usize,
    /// The plane before.
    pub west: &'a Plane<T>,
    /// The plane after.
    pub east: &'a Plane<T>,
}

impl<T: Number> Step<'_, T> {
    /// Runs the step.
    #[inline(always)]
    pub fn run(&self, plane: &mut Plane<T>, scratch: &mut Scratch<T>) {
        for j in self.shared.active.rows.clone() {
            let Some(span) = self.shared.cones.span(plane.i, j, self.step) else { continue };
            let (k, n) = span;
            self.step_h(plane, j, span);
            drive_row(&plane.magnets, j, k..k + n, self.step, &mut plane.e, &mut plane.h);
            self.step_e(plane, j, span, scratch);
            drive_row(&plane.drives, j, k..k + n, self.step, &mut plane.e, &mut plane.h);
            if let Some(dispersion) = &mut plane.dispersion {
                dispersion.relax_row(j, k, rows_mut(&mut plane.e, j, span), &scratch.old, &self.shared.poles);
            }
        }
    }

    /// H of `n` nodes of row `j` from node `k` on.
    #[inline(always)]
    fn step_h(&self, plane: &mut Plane<T>, j: usize, (k, n): (usize, usize)) {
        let active = self.shared.active.h;
        let Plane { e: [ex, ey, ez], h, magnetic, absorbing, .. } = plane;
        let [_, ey_east, ez_east] = &self.east.e;
        // The differences of E that make the curl, along x, y, z of each component.
        let (dx_z, dx_y) = ([ez.at(j, k, n), ez_east.at(j, k, n)], [ey.at(j, k, n), ey_east.at(j, k, n)]);
        let (dy_x, dy_z) = ([ex.at(j, k, n), ex.at(j + 1, k, n)], [ez.at(j, k, n), ez.at(j + 1, k, n)]);
        let (dz_y, dz_x) = ([ey.at(j, k, n), ey.at(j, k + 1, n)], [ex.at(j, k, n), ex.at(j, k + 1, n)]);
        let curls = [(dz_y, dy_z), (dx_z, dz_x), (dy_x, dx_y)];
        let [hx, hy, hz] = rows_mut(h, j, (k, n));
        match magnetic.as_deref() {
            None => {
                for (axis, h) in [&mut *hx, &mut *hy, &mut *hz].into_iter().enumerate() {
                    if active[axis] {
                        add_h(h, curls[axis].0, curls[axis].1);
                    }
                }
            }
            Some([da, db]) => {
                for (axis, h) in [&mut *hx, &mut *hy, &mut *hz].into_iter().enumerate() {
                    if active[axis] {
                        add_h_magnetic(h, da[axis].at(j, k, n), db[axis].at(j, k, n), curls[axis].0, curls[axis].1);
                    }
                }
            }
        }
        let Some(absorbing) = absorbing else { return };
        let db = magnetic.as_deref().map(|[_, db]| db);
        if let Some((profiles, memory)) = &mut absorbing.x {
            let [first, second] = &mut memory.h;
            if active[1] {
                self.absorb(hy, db.map(|db| db[1].at(j, k, n)), dx_z, first, (j, k), profiles, 2);
            }
            if active[2] {
                self.absorb(hz, db.map(|db| db[2].at(j, k, n)), dx_y, second, (j, k), profiles, 3);
            }
        }
        if let (Some((slot, profiles)), Some(memory)) = (&self.shared.y[j], &mut absorbing.y) {
            let [first, second] = &mut memory.h;
            self.absorb(hz, db.map(|db| db[2].at(j, k, n)), dy_x, first, (*slot, k), profiles, 2);
            self.absorb(hx, db.map(|db| db[0].at(j, k, n)), dy_z, second, (*slot, k), profiles, 3);
        }
        for (columns, memory) in self.shared.z.iter().zip(&mut absorbing.z) {
            let Some((begin, count)) = overlap(columns.k, columns.count, k, n) else { continue };
            let (from, within) = (begin - k, begin - columns.k);
            let [first, second] = &mut memory.h;
            let (x, y) = (db.map(|db| db[0].at(j, begin, count)), db.map(|db| db[1].at(j, begin, count)));
            let (hx, hy) = (&mut hx[from..][..count], &mut hy[from..][..count]);
            if active[0] {
                self.absorb_end(hx, x, part(dz_y, from, count), first, (j, within), columns, 2);
            }
            if active[1] {
                self.absorb_end(hy, y, part(dz_x, from, count), second, (j, within), columns, 3);
            }
        }
    }

    /// E of `n` nodes of row `j` from node `k` on.
    #[inline(always)]
    fn step_e(&self, plane: &mut Plane<T>, j: usize, (k, n): (usize, usize), scratch: &mut Scratch<T>) {
        let ([_, _, nz], active) = (self.shared.cells, self.shared.active.e);
        let Plane { i, e, h: [hx, hy, hz], grades, absorbing, dispersion, .. } = plane;
        let Some(grades) = grades else { return };
        let Scratch { lookup, old } = scratch;
        if let Some(dispersion) = dispersion {
            let [ex, ey, ez] = &*e;
            dispersion.keep(j, k, [ex.at(j, k, n), ey.at(j, k, n), ez.at(j, k, n)], old);
        }
        let grades = grades.row(self.shared.set, self.shared.table.as_ref(), j, (k, n), active, lookup);
        let [_, hy_west, hz_west] = &self.west.h;
        let (dx_z, dx_y) = ([hz_west.at(j, k, n), hz.at(j, k, n)], [hy_west.at(j, k, n), hy.at(j, k, n)]);
        let (dy_z, dy_x) = ([hz.south(j, k, n), hz.at(j, k, n)], [hx.south(j, k, n), hx.at(j, k, n)]);
        let (dz_y, dz_x) = ([hy.before(j, k, n), hy.at(j, k, n)], [hx.before(j, k, n), hx.at(j, k, n)]);
        let curls = [(dy_z, dz_y), (dz_x, dx_z), (dx_y, dy_x)];
        let [ex, ey, ez] = rows_mut(e, j, (k, n));
        let of = |axis: usize, ca| {
            let (a, b) = curls[axis];
            EdgeRow { ca, cb: grades.cb[axis], ratio: self.shared.ratio[axis], a, b }
        };
        for (axis, e) in [&mut *ex, &mut *ey, &mut *ez].into_iter().enumerate() {
            match grades.ca {
                _ if !active[axis] => {}
                None => add_curl(e, of(axis, &[])),
                Some(ca) => add_curl_lossy(e, of(axis, ca[axis])),
            }
        }
        if let Some(absorbing) = absorbing {
            let cb = grades.cb;
            if let Some((profiles, memory)) = &mut absorbing.x {
                let [first, second] = &mut memory.e;
                if active[1] {
                    self.absorb(ey, Some(cb[1]), dx_z, first, (j, k), profiles, 0);
                }
                if active[2] {
                    self.absorb(ez, Some(cb[2]), dx_y, second, (j, k), profiles, 1);
                }
            }
            if let (Some((slot, profiles)), Some(memory)) = (&self.shared.y[j], &mut absorbing.y) {
                let [first, second] = &mut memory.e;
                self.absorb(ez, Some(cb[2]), dy_x, first, (*slot, k), profiles, 0);
                self.absorb(ex, Some(cb[0]), dy_z, second, (*slot, k), profiles, 1);
            }
            for (columns, memory) in self.shared.z.iter().zip(&mut absorbing.z) {
                let Some((begin, count)) = overlap(columns.k, columns.count, k, n) else { continue };
                let (from, within) = (begin - k, begin - columns.k);
                let [first, second] = &mut memory.e;
                let (x, y) = (&cb[0][from..][..count], &cb[1][from..][..count]);
                let (ex, ey) = (&mut ex[from..][..count], &mut ey[from..][..count]);
                if active[0] {
                    self.absorb_end(ex, Some(x), part(dz_y, from, count), first, (j, within), columns, 0);
                }
                if active[1] {
                    self.absorb_end(ey, Some(y), part(dz_x, from, count), second, (j, within), columns, 1);
                }
            }
        }
        // The outer walls conduct perfectly, and nothing lies beyond them.
        if k == 0 {
            (ex[0], ey[0]) = (T::default(), T::default());
        }
        if nz < k + n {
            ex[nz - k..].fill(T::default());
            ey[nz - k..].fill(T::default());
            ez[nz - k..].fill(T::default());
        }
        if *i == 0 {
            ey.fill(T::default());
            ez.fill(T::default());
        }
        if j == 0 {
            ex.fill(T::default());
            ez.fill(T::default());
        }
    }

    /// Corrects a row within a slab across x or y; `scale` is absent for H where nothing is magnetic.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "a row, its coefficients and its memory")]
    fn absorb(
        &self,
        field: &mut [T],
        scale: Option<&[T]>,
        d: [&[T]; 2],
        store: &mut Store<T>,
        (row, k): (usize, usize),
        profiles: &Profiles<T>,
        of: usize,
    ) {
        let n = field.len();
        let phi = store.phi.at_mut(row, k, n);
        match (&mut store.second, &profiles.second, scale) {
            (Some(second), Some(filters), _) => {
                let scale = scale.unwrap_or(&self.shared.ones);
                absorb_row_twice(field, scale, d, [phi, second.at_mut(row, k, n)], filters[of]);
            }
            (_, _, None) => absorb_row(field, d, phi, profiles.first[of]),
            (_, _, Some(scale)) => absorb_row_scaled(field, scale, d, phi, profiles.first[of]),
        }
    }

    /// Corrects the end of a row that lies within a slab across z; `scale` is absent for H where nothing is magnetic.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "a row, its coefficients and its memory")]
    fn absorb_end(
        &self,
        field: &mut [T],
        scale: Option<&[T]>,
        d: [&[T]; 2],
        store: &mut Store<T>,
        (row, within): (usize, usize),
        columns: &Columns<T>,
        of: usize,
    ) {
        let n = field.len();
        let phi = store.phi.at_mut(row, within, n);
        match (&mut store.second, columns.filter(of, within), scale) {
            (Some(second), Some(filter), _) => {
                let scale = scale.unwrap_or(&self.shared.ones);
                absorb_columns_twice(field, scale, d, [phi, second.at_mut(row, within, n)], filter);
            }
            (_, _, None) => absorb_columns(field, d, phi, columns.profile(of, within)),
            (_, _, Some(scale)) => absorb_columns_scaled(field, scale, d, phi, columns.profile(of, within)),
        }
    }
}

/// `n` nodes from node `k` on of row `j` of three sheets. (A closure here would be compiled without the wide instructions
/// of its caller.)
#[inline(always)]
fn rows_mut<T: Number>(sheets: &mut [Sheet<T>; 3], j: usize, (k, n): (usize, usize)) -> [&mut [T]; 3] {
    let [x, y, z] = sheets;
    [x.at_mut(j, k, n), y.at_mut(j, k, n), z.at_mut(j, k, n)]
}

/// `count` nodes from node `k` on of both sides of a difference.
#[inline(always)]
fn part<T>([a, b]: [&[T]; 2], k: usize, count: usize) -> [&[T]; 2] {
    [&a[k..][..count], &b[k..][..count]]
}
