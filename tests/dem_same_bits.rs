//! The same set-up gives the same bits: on any number of threads, however it is split, and after a break.

mod dem_support;

use std::fs;

use ballast_gpr::geometry::triangle_mesh::{open_box, rectangle};
use ballast_gpr::packing::dem::{DemError, Motion, Rolling, Setup, Simulation, Stuff, TimeStep, Wall};
use ballast_gpr::units::Seconds;
use dem_support::{Numbers, ONE, bits, loose_heap, sphere, threads};

/// 300 stones that fall into a box of triangles, two materials, a plate that lifts and turns and one that floats; larger
/// steps, so that they arrive.
fn busy(rolling: Rolling) -> Simulation {
    let mut setup = loose_heap(300, 0.6, 7);
    setup.time_step = TimeStep::Seconds(1.5e-5);
    setup.rolling = rolling;
    setup.stuffs.push(Stuff { young: 5e9, friction: 0.3, rolling_friction: 0.1, ..Stuff::BALLAST });
    for (n, grain) in setup.grains.iter_mut().enumerate() {
        grain.material = n % 2;
        grain.velocity = [0.3 * (n % 5) as f64, -0.2, -2.0];
        grain.spin = [1.0, 0.0, n as f64 % 3.0];
    }
    let plate = rectangle([0.1, 0.1, -0.03], [0.2, 0.0, 0.0], [0.0, 0.2, 0.0]).unwrap();
    let about = [0.2, 0.2, -0.03];
    let lifts = Motion::Prescribed { velocity: [0.0, 0.0, 1.5], spin: [0.0, 1.0, 0.0], about, from: 0.01, until: 0.03 };
    let box_of_triangles = open_box([0.0; 3], [0.6, 0.6, 2.0]).unwrap();
    let floats = rectangle([0.35, 0.35, -0.02], [0.2, 0.0, 0.0], [0.0, 0.2, 0.0]).unwrap();
    let free =
        Motion::Free { mass: 20.0, moves: [false, false, true], velocity: [0.1, 0.0, 1.0], load: [0.0, 0.0, 196.2] };
    setup.walls =
        vec![Wall::mesh(box_of_triangles, 0), Wall::mesh(plate, 1).moving(lifts), Wall::mesh(floats, 0).moving(free)];
    Simulation::new(setup).unwrap()
}

const MODELS: [Rolling; 4] =
    [Rolling::None, Rolling::Bounded, Rolling::ConstantTorque, Rolling::ElasticPlastic { damping: 0.3 }];

#[test]
fn threads_and_calls_change_no_bit() {
    for rolling in MODELS {
        let mut one = busy(rolling);
        one.run_quietly(8000, ONE).unwrap();
        assert!(one.contacts().len() > 10 && one.wall_contacts().len() > 10);
        for count in [2, 4] {
            let mut other = busy(rolling);
            // Every thread that is allowed, however little there is to do.
            other.set_least_work(Seconds(0.0));
            for steps in [1, 999, 6500, 500] {
                other.run_quietly(steps, threads(count)).unwrap();
            }
            assert_eq!(bits(&one), bits(&other), "{rolling:?} on {count} threads");
            assert_eq!(one.wall_loads(), other.wall_loads());
            assert_eq!(one.contacts(), other.contacts());
        }
    }
}

/// Broken off at steps chosen at random, written, read by somebody else and gone on with: the same bits to the end.
#[test]
fn a_break_changes_no_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bed.state");
    let mut numbers = Numbers(3);
    for rolling in MODELS {
        let mut whole = busy(rolling);
        whole.run_quietly(6000, ONE).unwrap();
        let mut broken = busy(rolling);
        let mut left = 6000;
        while left > 0 {
            let steps = (1 + (numbers.next() * 1800.0) as u64).min(left);
            broken.run_quietly(steps, threads(2)).unwrap();
            left -= steps;
            broken.save(&path).unwrap();
            let loads = broken.wall_loads();
            broken = Simulation::load(&path).unwrap();
            assert_eq!(broken.wall_loads(), loads);
        }
        assert_eq!(bits(&whole), bits(&broken), "{rolling:?}");
        assert_eq!(whole.step(), broken.step());
        assert_eq!(whole.time(), broken.time());
        assert_eq!(whole.wall_state(1), broken.wall_state(1));
        assert_eq!(whole.unbalanced_force_ratio(), broken.unbalanced_force_ratio());
    }
}

/// A file that is cut short, changed in any of many places or of something else is refused with its name.
#[test]
fn a_damaged_state_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bed.state");
    let mut simulation = busy(Rolling::Bounded);
    simulation.run_quietly(1500, ONE).unwrap();
    simulation.save(&path).unwrap();
    let whole = fs::read(&path).unwrap();
    let first_line = whole.iter().position(|&byte| byte == b'\n').unwrap();
    let mut numbers = Numbers(11);
    for n in 0..60 {
        let mut bytes = whole.clone();
        let at = first_line + 1 + (numbers.next() * (bytes.len() - first_line - 1) as f64) as usize;
        if n % 3 == 0 {
            bytes.truncate(at);
        } else {
            bytes[at] ^= 1 << (n % 8);
        }
        fs::write(&path, &bytes).unwrap();
        let Err(error) = Simulation::load(&path) else {
            panic!("byte {at} of {} is changed, and nobody noticed", whole.len());
        };
        assert!(matches!(error, DemError::NotAState { .. }), "{error}");
        assert!(error.to_string().contains("bed.state"), "{error}");
    }
    fs::write(&path, "x,y\n1,2\n").unwrap();
    let error = Simulation::load(&path).unwrap_err();
    assert!(error.to_string().ends_with("cannot be gone on from: it is not the state of a simulation of spheres"));
}

/// A coefficient of zero is the same as an effect that is switched off: bit by bit.
#[test]
fn zero_strength_is_absence() {
    let run = |setup: Setup| {
        let mut simulation = Simulation::new(setup).unwrap();
        simulation.run_quietly(8000, threads(2)).unwrap();
        (bits(&simulation), simulation.coordination_number())
    };
    let heap = || {
        let mut setup = loose_heap(200, 0.5, 5);
        setup.time_step = TimeStep::Seconds(1.5e-5);
        setup.grains.iter_mut().for_each(|grain| grain.velocity[2] = -2.0);
        setup
    };
    let (mut zero, mut absent, full) = (heap(), heap(), heap());
    zero.stuffs[0].friction = 0.0;
    absent.friction = false;
    let (zero, absent, (full, touching)) = (run(zero), run(absent), run(full));
    assert!(touching > 0.2, "{touching}");
    assert_eq!(zero, absent);
    assert_ne!(zero.0, full);
    let (mut zero, mut absent) = (heap(), heap());
    zero.stuffs[0].rolling_friction = 0.0;
    absent.rolling = Rolling::None;
    let (zero, absent) = (run(zero), run(absent));
    assert_eq!(zero, absent);
    assert_ne!(zero.0, full);
}

/// Grains that cross a periodic side are the same as grains that do not: the same pair, shifted by more than half the box.
#[test]
fn a_pair_meets_across_a_periodic_side() {
    let meet = |shift: f64| {
        let mut grains = vec![sphere([0.20 + shift, 0.1, 0.5], 0.02), sphere([0.25 + shift, 0.11, 0.5], 0.025)];
        grains[0].velocity[0] = 1.0;
        for grain in &mut grains {
            grain.sphere.centre[0] %= 0.5;
        }
        let mut setup = Setup::new(Stuff::BALLAST, grains);
        setup.periodic = [Some([0.0, 0.5]), None];
        setup.gravity = [0.0; 3];
        let mut simulation = Simulation::new(setup).unwrap();
        simulation.run_quietly(3000, ONE).unwrap();
        let [a, b] = [0, 1].map(|n| simulation.grain(n).unwrap());
        assert!(b.velocity[0] > 0.2, "{:?}", b.velocity);
        [a, b].map(|grain| [grain.velocity, grain.spin])
    };
    let (inside, across) = (meet(0.0), meet(0.28));
    for (inside, across) in inside.iter().flatten().flatten().zip(across.iter().flatten().flatten()) {
        assert!((inside - across).abs() < 1e-6, "{inside} {across}");
    }
}
