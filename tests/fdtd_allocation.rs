//! The loop over the steps allocates nothing.

mod fdtd_support;

use std::alloc::{GlobalAlloc, Layout, System};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use ballast_gpr::fdtd::{InstructionSet, Precision, Stepping};
use ballast_gpr::model::{DebyePole, Material, MaterialId, paint};
use fdtd_support::{box_of, fdtd, scene};

/// The system's allocator, counting.
struct Counting;

static CALLS: AtomicUsize = AtomicUsize::new(0);

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
