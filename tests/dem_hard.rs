//! Hard cases: what blows up elsewhere is refused, stopped by name, or borne.

mod dem_support;

use ballast_gpr::geometry::triangle_mesh::{TriangleMesh, closed_box, open_box, rectangle};
use ballast_gpr::packing::dem::{DemError, Motion, Pairing, Setup, Simulation, Stuff, TimeStep, Wall};
use dem_support::{ONE, floor, loose_heap, mass, sphere, threads};

fn refused(setup: Setup) -> String {
    match Simulation::new(setup) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("it was taken"),
    }
}

fn one() -> Setup {
    let mut setup = Setup::new(Stuff::BALLAST, vec![sphere([0.0, 0.0, 0.05], 0.025)]);
    setup.walls.push(floor());
    setup
}

#[test]
fn grains_that_overlap_deeply_are_refused_by_number() {
    let mut setup = one();
    setup.grains.push(sphere([0.04, 0.0, 0.05], 0.025));
    assert_eq!(
        refused(setup).lines().next().unwrap(),
        "grains 0 and 1 overlap by 10.0000 mm at the start, 40.0 % of the smaller radius; the limit is 2.0 %"
    );
    let mut setup = one();
    setup.grains[0].sphere.centre[2] = 0.02;
    assert!(refused(setup).starts_with("grain 0 lies 5.0000 mm deep in wall 0"));
    // Two grains at the same place have no normal.
    let mut setup = one();
    setup.grains.push(setup.grains[0]);
    assert!(refused(setup).starts_with("grains 0 and 1 overlap by 50.0000 mm"));
}

/// An overlap within the limit is resolved: the grains part, and no faster than the energy of the overlap lets them.
#[test]
fn an_overlap_within_the_limit_is_resolved() {
    let radius = 0.025;
    let overlap = 0.015 * radius;
    let mut setup =
        Setup::new(Stuff::BALLAST, vec![sphere([0.0; 3], radius), sphere([2.0 * radius - overlap, 0.0, 0.0], radius)]);
    setup.gravity = [0.0; 3];
    let mut simulation = Simulation::new(setup).unwrap();
    let energy = simulation.elastic_energy();
    // 8/15 E* √R* δ^2.5.
    let e_star = 17.7e9 / (2.0 * (1.0 - 0.18_f64.powi(2)));
    let wanted = 8.0 / 15.0 * e_star * (radius / 2.0_f64).sqrt() * overlap.powf(2.5);
    assert!((energy / wanted - 1.0).abs() < 1e-9, "{energy} J for {wanted} J");
    simulation.run_quietly(2000, ONE).unwrap();
    assert!(simulation.contacts().is_empty());
    assert!(simulation.kinetic_energy() < wanted && simulation.kinetic_energy() > 0.01 * wanted);
}

/// A fine grain of 5 mm between two stones of 100 mm, and a layer of fines under one.
#[test]
fn sizes_of_one_to_twenty_get_along() {
    let mut grains = vec![sphere([0.0, 0.0, 0.0557], 0.05)];
    for n in 0..400 {
        let (i, j) = (n % 20, n / 20);
        grains.push(sphere([(f64::from(i) - 9.5) * 0.0052, (f64::from(j) - 9.5) * 0.0052, 0.0026], 0.0025));
    }
    let mut setup = Setup::new(Stuff::BALLAST, grains);
    setup.walls.push(floor());
    let mut simulation = Simulation::new(setup).unwrap();
    simulation.run_quietly(20_000, threads(2)).unwrap();
    assert!(simulation.lost().is_empty());
    let stone = simulation.grain(0).unwrap();
    assert!(stone.sphere.centre[2] > 0.05 && stone.sphere.centre[2] < 0.0557, "{:?}", stone.sphere);
}

#[test]
fn a_time_step_beyond_the_limit_is_refused_with_a_good_one() {
    let mut setup = one();
    // Rayleigh time: π R √(ρ/G)/(0.1631 ν + 0.8766) = 52.2 µs.
    setup.time_step = TimeStep::Seconds(5.3e-5);
    let message = refused(setup);
    assert!(message.starts_with("the time step of") && message.contains("grain 0"), "{message}");
    let mut setup = one();
    setup.time_step = TimeStep::Seconds(5.2e-5);
    let simulation = Simulation::new(setup).unwrap();
    assert!(simulation.step_length().is_worth_a_warning());
    let mut setup = one();
    setup.time_step = TimeStep::ShareOfRayleigh(0.2);
    assert!(!Simulation::new(setup).unwrap().step_length().is_worth_a_warning());
}

/// Twenty times the Rayleigh time: the run is stopped, and the message names the step and a grain.
#[test]
fn a_time_step_far_beyond_the_limit_is_stopped_by_the_watchdog() {
    let mut setup = loose_heap(100, 0.4, 2);
    setup.time_step = TimeStep::Unchecked(5e-4);
    let mut simulation = Simulation::new(setup).unwrap();
    let error = simulation.run_quietly(100_000, ONE).unwrap_err();
    let (step, grain) = match error {
        DemError::EnergyGrows { step, grain, .. }
        | DemError::TooFast { step, grain, .. }
        | DemError::TooDeep { step, grain, .. } => (step, grain),
        other => panic!("{other}"),
    };
    assert!(step > 0 && step == simulation.step() && grain < 100);
    assert!(error.to_string().starts_with(&format!("stopped at step {step}: ")), "{error}");
}

/// 10 m/s onto the corner of a block: back off it, not through it, and with less energy.
#[test]
fn an_impact_on_a_corner_at_ten_metres_per_second_bounces() {
    for offset in [[0.0, 0.0], [0.004, 0.007]] {
        let block = closed_box([-0.2; 3], [0.0; 3]).unwrap();
        let toward = (1.0_f64 / 3.0).sqrt();
        let place = [0.05 * toward + offset[0], 0.05 * toward + offset[1], 0.05 * toward];
        let mut grain = sphere(place, 0.025);
        grain.velocity = [-10.0 * toward; 3];
        let mut setup = Setup::new(Stuff::BALLAST, vec![grain]);
        setup.walls.push(Wall::mesh(block, 0));
        setup.gravity = [0.0; 3];
        let mut simulation = Simulation::new(setup).unwrap();
        let before = simulation.kinetic_energy();
        simulation.run_quietly(5000, ONE).unwrap();
        let after = simulation.grain(0).unwrap();
        let out: f64 = after.velocity.iter().map(|v| v * toward).sum();
        assert!(out > 1.0, "{:?}", after.velocity);
        assert!(after.sphere.centre.iter().all(|&x| x > 0.0), "{:?}", after.sphere);
        assert!(simulation.kinetic_energy() < before);
        if offset == [0.0, 0.0] {
            assert!((out / 4.0 - 1.0).abs() < 0.02, "restitution 0.4 of 10 m/s: {out}");
        }
    }
}

/// A floor of two triangles: on their shared edge a stone rests at the same height as on a face, pressed once, and a ball
/// that rolls across the edge does not hop.
#[test]
fn a_shared_edge_is_not_felt() {
    let rest = |x: f64| {
        let mesh = rectangle([-0.2, -0.2, 0.0], [0.4, 0.0, 0.0], [0.0, 0.4, 0.0]).unwrap();
        let mut setup = Setup::new(Stuff::BALLAST, vec![sphere([x, 0.0, 0.025], 0.025)]);
        setup.walls.push(Wall::mesh(mesh, 0));
        let mut simulation = Simulation::new(setup).unwrap();
        simulation.run_quietly(30_000, ONE).unwrap();
        assert_eq!(simulation.wall_contacts().len(), 1);
        simulation.grain(0).unwrap().sphere.centre[2]
    };
    assert!((rest(0.0) - rest(0.06)).abs() < 1e-12);

    let roll = |mesh: Option<TriangleMesh>| {
        let mut grain = sphere([-0.02, 0.013, 0.025 - 4e-7], 0.025);
        grain.velocity = [1.0, 0.3, 0.0];
        let mut setup = Setup::new(Stuff::BALLAST, vec![grain]);
        setup.walls.push(mesh.map_or(floor(), |mesh| Wall::mesh(mesh, 0)));
        let mut simulation = Simulation::new(setup).unwrap();
        let mut highest = 0.0_f64;
        for _ in 0..200 {
            simulation.run_quietly(100, ONE).unwrap();
            highest = highest.max(simulation.grain(0).unwrap().sphere.centre[2]);
        }
        (simulation.grain(0).unwrap(), highest)
    };
    let mesh = rectangle([-0.3, -0.3, 0.0], [0.6, 0.0, 0.0], [0.0, 0.6, 0.0]).unwrap();
    let ((on_mesh, high_on_mesh), (on_plane, high_on_plane)) = (roll(Some(mesh)), roll(None));
    assert!(on_plane.sphere.centre[0] > 0.05, "it crosses the diagonal");
    for k in 0..3 {
        assert!((on_mesh.sphere.centre[k] - on_plane.sphere.centre[k]).abs() < 1e-9);
        assert!((on_mesh.velocity[k] - on_plane.velocity[k]).abs() < 1e-7);
    }
    assert!((high_on_mesh - high_on_plane).abs() < 1e-9);
}

/// Two plates that close on a stone: the overlap alarm stops the press, naming the stone; slow and open again it stays whole.
#[test]
fn a_stone_squeezed_between_plates_is_named() {
    let squeeze = |until: f64| {
        let down = Motion::Prescribed { velocity: [0.0, 0.0, -0.5], spin: [0.0; 3], about: [0.0; 3], from: 0.0, until };
        let plate = rectangle([-0.1, -0.1, 0.051], [0.2, 0.0, 0.0], [0.0, 0.2, 0.0]).unwrap();
        let mut setup = Setup::new(Stuff::BALLAST, vec![sphere([0.0, 0.0, 0.025], 0.025)]);
        setup.walls = vec![floor(), Wall::mesh(plate, 0).moving(down)];
        let mut simulation = Simulation::new(setup).unwrap();
        simulation.run_quietly(5000, ONE).map(|()| simulation)
    };
    // 5000 steps are 52 ms: 26 mm.
    let error = squeeze(1.0).unwrap_err();
    assert!(matches!(error, DemError::TooDeep { grain: 0, .. }), "{error}");
    // 2.2 mm down: each side is pressed in by 0.6 mm, with 4/3 E* √R δ^1.5 on it.
    let simulation = squeeze(0.0044).unwrap();
    let loads = simulation.wall_loads();
    let e_star = 17.7e9 / (2.0 * (1.0 - 0.18_f64.powi(2)));
    let moved = simulation.wall_state(1).unwrap().displacement[2];
    let force = 4.0 / 3.0 * e_star * 0.025_f64.sqrt() * ((-moved - 0.001) / 2.0).powf(1.5);
    assert!((loads[1].force[2] / force - 1.0).abs() < 1e-3, "{} N for {force} N", loads[1].force[2]);
    assert!((loads[0].force[2] / -force - 1.0).abs() < 1e-3);
}

/// A heap that lies still for a million steps: its energy does not grow.
#[test]
fn a_heap_lies_still_for_a_million_steps() {
    let radius = 0.025;
    let mut grains = vec![];
    let side = 2.0 * radius + 1e-6;
    for (x, y) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
        grains.push(sphere([x * side, y * side, radius], radius));
    }
    let top = radius + radius * 2.0_f64.sqrt() + 1e-5;
    grains.push(sphere([0.5 * side, 0.5 * side, top], radius));
    let mut setup = Setup::new(Stuff::BALLAST, grains);
    setup.walls.push(floor());
    let mut simulation = Simulation::new(setup).unwrap();
    simulation.run_quietly(100_000, ONE).unwrap();
    let (energy, height) = (simulation.kinetic_energy(), simulation.grain(4).unwrap().sphere.centre[2]);
    assert!(energy < 1e-12, "{energy} J");
    assert!(height > 2.0 * radius, "the heap holds: {height} m");
    for _ in 0..9 {
        simulation.run_quietly(100_000, ONE).unwrap();
        assert!(simulation.kinetic_energy() < 1e-12, "{} J", simulation.kinetic_energy());
    }
    assert!((simulation.grain(4).unwrap().sphere.centre[2] - height).abs() < 1e-8);
    // A new list of neighbours changes nothing of what is told: the top stone is borne by four.
    let contacts = simulation.contacts();
    simulation.set_present(0, true).unwrap();
    assert_eq!(simulation.contacts(), contacts);
    let bearing = contacts.iter().filter(|contact| contact.grains[1] == 4);
    let borne: f64 = bearing.map(|contact| -contact.force[2]).sum();
    assert!((borne / (mass(radius) * 9.81) - 1.0).abs() < 1e-3, "{borne} N");
    assert!(simulation.unbalanced_force_ratio() < 1e-3, "{}", simulation.unbalanced_force_ratio());
}

/// Stones that leave the domain are counted with step and place; the others go on, and numbers stay.
#[test]
fn stones_that_leave_are_counted() {
    let mut grains: Vec<_> = (0..6).map(|n| sphere([0.1 * f64::from(n), 0.0, 0.1], 0.02)).collect();
    grains[2].velocity[1] = 5.0;
    grains[5].velocity[1] = 3.0;
    let mut setup = Setup::new(Stuff::BALLAST, grains);
    setup.walls.push(floor());
    setup.domain = [[-1.0, -0.5, -0.5], [1.0, 0.5, 1.0]];
    let mut simulation = Simulation::new(setup).unwrap();
    simulation.run_quietly(40_000, ONE).unwrap();
    let lost: Vec<usize> = simulation.lost().iter().map(|lost| lost.grain).collect();
    assert_eq!(lost, [2, 5]);
    assert!(simulation.lost()[0].step < simulation.lost()[1].step);
    assert!(simulation.lost()[0].grain_then.sphere.centre[1] > 0.5);
    assert_eq!(simulation.grains().len(), 6);
    assert!(simulation.grain(2).is_none());
    assert!((simulation.grain(4).unwrap().sphere.centre[0] - 0.4).abs() < 1e-3);
}

/// What cannot be is refused, each with its own words.
#[test]
fn bad_input_is_refused_by_name() {
    let with = |change: &dyn Fn(&mut Setup)| {
        let mut setup = one();
        change(&mut setup);
        refused(setup)
    };
    let bad = |change: &dyn Fn(&mut Setup), wanted: &str| {
        let message = with(change);
        assert!(message.starts_with(wanted), "{message}\n  for {wanted}");
    };
    bad(&|s| s.stuffs[0].density = -1.0, "the density of material 0 is -1, and must be above zero");
    bad(&|s| s.stuffs[0].young = 0.0, "the modulus of Young of material 0 is 0, and must be above zero, in Pa");
    bad(&|s| s.stuffs[0].poisson = 0.7, "the ratio of Poisson of material 0 is 0.7");
    bad(&|s| s.stuffs[0].restitution = 1.2, "the restitution of material 0 is 1.2");
    bad(&|s| s.stuffs[0].friction = f64::NAN, "the friction of material 0 is NaN");
    bad(&|s| s.stuffs[0].rolling_friction = -0.1, "the rolling friction of material 0 is -0.1");
    bad(&|s| s.grains[0].material = 3, "grain 0 is of material 3, and there are 1");
    bad(&|s| s.walls[0].material = 1, "wall 0 is of material 1, and there are 1");
    bad(&|s| s.grains[0].sphere.radius = 0.0, "the radius of grain 0 is 0, and must be above zero");
    bad(&|s| s.grains[0].velocity[1] = f64::INFINITY, "the velocity of grain 0 is inf, and must be finite");
    bad(&|s| s.time_step = TimeStep::Seconds(0.0), "the time step of");
    bad(&|s| s.periodic[0] = Some([0.0, 0.04]), "the periodic box is 0.04 m wide along x");
    bad(&|s| s.domain = [[0.0; 3], [1.0, 1.0, 0.04]], "the domain is 0.04 m wide along z");
    bad(
        &|s| s.pairings = vec![Pairing { materials: [0, 0], friction: Some(-1.0), restitution: None }],
        "the friction of pairing 0 is -1",
    );
    bad(
        &|s| {
            s.walls[0].motion =
                Motion::Prescribed { velocity: [0.0; 3], spin: [1.0, 0.0, 0.0], about: [0.0; 3], from: 0.0, until: 1.0 }
        },
        "wall 0 cannot move so: a plane has no end",
    );
    bad(
        &|s| s.walls[0].motion = Motion::Free { mass: 0.0, moves: [true; 3], velocity: [0.0; 3], load: [0.0; 3] },
        "wall 0 cannot move so: the mass",
    );
}

/// A plate of 10 kg that may sink rests on four stones: each bears a quarter of its weight and its own.
#[test]
fn a_free_plate_rests_on_stones() {
    let radius = 0.025;
    let places = [(0.0, 0.0), (0.2, 0.0), (0.0, 0.2), (0.2, 0.2)];
    let grains: Vec<_> = places.iter().map(|&(x, y)| sphere([x, y, radius], radius)).collect();
    let plate = rectangle([-0.1, -0.1, 2.0 * radius + 1e-5], [0.4, 0.0, 0.0], [0.0, 0.4, 0.0]).unwrap();
    let free = Motion::Free { mass: 10.0, moves: [false, false, true], velocity: [0.0; 3], load: [0.0; 3] };
    let mut setup = Setup::new(Stuff::BALLAST, grains);
    setup.walls =
        vec![floor(), Wall::mesh(plate, 0).moving(free), Wall::mesh(open_box([-0.5; 3], [0.8; 3]).unwrap(), 0)];
    let mut simulation = Simulation::new(setup).unwrap();
    simulation.run_quietly(30_000, threads(2)).unwrap();
    let loads = simulation.wall_loads();
    assert!((loads[1].force[2] / 98.1 - 1.0).abs() < 1e-4, "{:?}", loads[1]);
    let weight = 4.0 * mass(radius) * 9.81;
    assert!((loads[0].force[2] / -(98.1 + weight) - 1.0).abs() < 1e-4, "{:?}", loads[0]);
    // A new list of neighbours changes nothing of what is told.
    let (contacts, ratio) = (simulation.contacts(), simulation.unbalanced_force_ratio());
    simulation.set_present(2, false).unwrap();
    assert_eq!((simulation.contacts(), simulation.unbalanced_force_ratio()), (contacts, ratio));
    // Taken away, the stones bear themselves only.
    simulation.set_present(1, false).unwrap();
    simulation.run_quietly(10_000, ONE).unwrap();
    let loads = simulation.wall_loads();
    assert!((loads[0].force[2] / -weight - 1.0).abs() < 1e-4, "{:?}", loads[0]);
    assert_eq!(loads[1].contacts, 0);
}
