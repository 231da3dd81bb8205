//! The loop over the steps allocates nothing, and a run in three dimensions takes the memory that was said.

mod fdtd_support;

use std::alloc::{GlobalAlloc, Layout, System};
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use ballast_gpr::fdtd::{InstructionSet, Precision, Stepping};
use ballast_gpr::model::{
    Axis, DebyePole, Excitation, Grid, HertzianDipole, Material, MaterialId, Model, Object, Receiver, Source,
    TimeWindow, Waveform, WaveformKind, paint,
};
use fdtd_support::{box_of, fdtd, scene};

/// The system's allocator, counting.
struct Counting;

static CALLS: AtomicUsize = AtomicUsize::new(0);
/// The tests of this file count one after the other.
static TURN: Mutex<()> = Mutex::new(());

// SAFETY: every call is handed to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        CALLS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller keeps the contract of `alloc`.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the contract of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// A run of 1000 steps makes as many calls to the allocator as one of 100: none of them is in the loop.
#[test]
fn steps_allocate_nothing() {
    let _turn = TURN.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let calls = |steps, threads| {
        let mut model = scene([200, 200], 0.002, steps, [100, 150], &[[120, 150], [100, 60]]);
        let mut wet = Material::dielectric("wet", 3.0, 0.01);
        wet.poles.push(DebyePole { delta_eps: 4.0, tau: 9e-12 });
        wet.averagable = false;
        let wet = model.add_material(wet);
        model.objects.push(box_of(&model, [0, 0, 200, 100], wet, true));
        model.objects.push(box_of(&model, [90, 20, 110, 40], MaterialId::PEC, true));
        let painted = paint(&model).unwrap();
        // With two threads all nodes are stepped, so that the cut between the blocks, which follows the work, and with it
        // the number of sources that a block stores, is the same for both lengths.
        let stepping = Stepping { skip: threads == 1, ..Stepping::default() };
        let solver = fdtd(Precision::Single, threads, InstructionSet::Auto);
        let before = CALLS.load(Ordering::Relaxed);
        solver.solve_stepping(&model, &painted, stepping, &|_| ControlFlow::Continue(())).unwrap();
        CALLS.load(Ordering::Relaxed) - before
    };
    // The counter also sees what the test runner's own thread does meanwhile, which only ever adds: the least of several
    // runs is the solver's. A single allocation in the loop would add 900 calls to every long run.
    let least = |steps, threads| (0..7).map(|_| calls(steps, threads)).min().unwrap();
    for threads in [1, 2] {
        assert_eq!(least(100, threads), least(1000, threads), "{threads} threads");
    }
}

/// Spheres of stone in a box, with a dipole and a receiver in its middle; `wet` adds water films, loss and a rail.
fn bed(cells: [usize; 3], steps: usize, absorbing: usize, wet: bool) -> Model {
    let d = 0.004;
    let size = cells.map(|count| count as f64 * d);
    let mut model = Model::new("bed", Grid { cells, spacing: [d; 3] }, TimeWindow::Iterations(steps));
    model.pml_cells = Some([absorbing; 6]);
    let stone = model.add_material(Material::dielectric("stone", 6.0, if wet { 0.001 } else { 0.0 }));
    for k in 0..300 {
        let place = |factor: f64, size: f64| (f64::from(k) * factor).fract() * size;
        let centre = [place(0.618, size[0]), place(0.755, size[1]), place(0.57, size[2])];
        let radius = 0.055 * size[0];
        model.objects.push(Object::Sphere { centre, radius, material: stone, averaging: true });
    }
    if wet {
        let mut film = Material { mu_r: 1.5, ..Material::dielectric("film", 3.0, 0.01) };
        film.poles.push(DebyePole { delta_eps: 4.0, tau: 9e-12 });
        film.averagable = false;
        for material in [model.add_material(film), MaterialId::PEC] {
            let upper = size.map(|size| 0.3 * size);
            let lower = if material == MaterialId::PEC { upper.map(|v| 0.5 * v) } else { [0.0; 3] };
            model.objects.push(Object::Box { lower, upper, material, averaging: true });
        }
    }
    model.waveforms.push(Waveform { id: "w".into(), kind: WaveformKind::Ricker, amplitude: 1.0, frequency: 1e9 });
    let (position, excitation) = (size.map(|size| 0.5 * size), Excitation { start: 0.0, stop: None });
    let dipole = HertzianDipole { polarisation: Axis::X, position, waveform: 0, excitation };
    model.sources.push(Source::HertzianDipole(dipole));
    model.receivers.push(Receiver { position, name: None });
    model
}

/// As [`steps_allocate_nothing`], in three dimensions, every effect present.
#[test]
fn steps_in_three_dimensions_allocate_nothing() {
    let _turn = TURN.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let calls = |steps, threads| {
        let model = bed([28, 30, 33], steps, 4, true);
        let solver = fdtd(Precision::Single, threads, InstructionSet::Auto);
        let before = CALLS.load(Ordering::Relaxed);
        let (_, stats) = solver.solve_stats(&model, &|_| ControlFlow::Continue(())).unwrap();
        assert_eq!(stats.threads, threads);
        CALLS.load(Ordering::Relaxed) - before
    };
    let least = |steps, threads| (0..7).map(|_| calls(steps, threads)).min().unwrap();
    for threads in [1, 2] {
        assert_eq!(least(40, threads), least(400, threads), "{threads} threads");
    }
}

/// A line of the kernel's account of this process, bytes.
#[cfg(target_os = "linux")]
fn account(line: &str) -> f64 {
    let text = std::fs::read_to_string("/proc/self/status").expect("the memory of a process is told by Linux");
    let found = text.lines().find_map(|found| found.strip_prefix(line)).expect("such a line");
    found.trim_end_matches("kB").trim().parse::<f64>().expect("a number") * 1024.0
}

/// Which run a child process is to measure.
#[cfg(target_os = "linux")]
const ABSORBING: &str = "FDTD_ALLOCATION_ABSORBING";

/// Two hundred cells along each axis, lossless stones: six fields of four bytes and three indices of one byte make 27 bytes
/// a cell; rounding rows up to whole vectors (208 for 200) and the rims add 1.7, what sources and receivers hold 0.15. All
/// memory that the process has held at its worst during the run, painting included, is within 2 % of what it says
/// beforehand: the fields lie in a mapping, which no allocator sees, so the kernel's account counts, of a process that has
/// done nothing else. (Absorbing cells take 16 bytes more for each side.)
#[test]
#[cfg(target_os = "linux")]
fn a_lossless_cell_takes_less_than_thirty_bytes() {
    if let Ok(absorbing) = std::env::var(ABSORBING) {
        return hold_to_what_is_said(absorbing.parse().expect("a number of cells"));
    }
    let _turn = TURN.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    for absorbing in ["0", "10"] {
        let mut child = std::process::Command::new(std::env::current_exe().expect("this program"));
        child
            .args(["--exact", "a_lossless_cell_takes_less_than_thirty_bytes", "--nocapture"])
            .env(ABSORBING, absorbing);
        let output = child.output().expect("it starts again");
        print!("{}", String::from_utf8_lossy(&output.stdout));
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

#[cfg(target_os = "linux")]
fn hold_to_what_is_said(absorbing: usize) {
    let most = if absorbing == 0 { 29.2 } else { 45.0 };
    let mut model = bed([200; 3], 60, absorbing, false);
    // Where no wave comes that a receiver hears of, memory is never touched: sources and receivers everywhere.
    let (source, receiver) = (model.sources.remove(0), model.receivers.remove(0));
    for place in 0..343 {
        let position = [place / 49, place / 7 % 7, place % 7].map(|k| 4e-3 * f64::from(16 + 28 * k));
        let Source::HertzianDipole(dipole) = &source else { panic!("a current") };
        model.sources.push(Source::HertzianDipole(HertzianDipole { position, ..dipole.clone() }));
        model.receivers.push(Receiver { position, ..receiver.clone() });
    }
    // The greatest resident memory is counted from here on.
    std::fs::write("/proc/self/clear_refs", "5").expect("the account can be set back");
    let before = account("VmRSS:");
    let solver = fdtd(Precision::Single, 1, InstructionSet::Auto);
    let (_, stats) = solver.solve_stats(&model, &|_| ControlFlow::Continue(())).unwrap();
    let held = account("VmHWM:") - before;
    let cells = model.grid.cell_count() as f64;
    let (said, found) = (stats.bytes as f64 / cells, held / cells);
    println!("{absorbing} absorbing cells: said {said:.2} bytes a cell, found {found:.2}");
    assert!(said < most, "{absorbing} absorbing cells: {said:.2} bytes a cell");
    assert!((found / said - 1.0).abs() < 0.02, "{absorbing} absorbing cells: said {said:.2}, found {found:.2}");
}
