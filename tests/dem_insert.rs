//! Grains that come in while a simulation goes on: contacts keep their memory, and what cannot be changes nothing.

mod dem_support;

use ballast_gpr::geometry::Sphere;
use ballast_gpr::packing::dem::{DemError, Grain, Setup, Simulation, Stuff, TimeStep, Wall};
use dem_support::{ONE, bits, mass, sphere};

/// A stone on a slope of ten degrees, which friction and rolling friction hold.
fn on_a_slope() -> Simulation {
    let slope = 10_f64.to_radians();
    let mut setup = Setup::new(Stuff::BALLAST, vec![sphere([0.0, 0.0, 0.025], 0.025)]);
    setup.walls = vec![Wall::plane([0.0; 3], [0.0, 0.0, 1.0], 0)];
    setup.gravity = [9.81 * slope.sin(), 0.0, -9.81 * slope.cos()];
    setup.time_step = TimeStep::Seconds(5e-6);
    let mut simulation = Simulation::new(setup).unwrap();
    simulation.run_quietly(100_000, ONE).unwrap();
    simulation
}

/// The force along a slope that holds a stone is `m g sin b`, and it is a memory: a simulation that begins with the stone where it
/// lies knows nothing of it. After another stone has come in, far away, it is there in the very next step.
#[test]
fn contacts_remember_when_a_stone_comes_in() {
    let mut simulation = on_a_slope();
    let along = |simulation: &Simulation| -simulation.wall_loads()[0].force[0];
    let held = mass(0.025) * 9.81 * 10_f64.to_radians().sin();
    assert!((along(&simulation) / held + 1.0).abs() < 1e-3, "{} {held}", along(&simulation));
    let before = along(&simulation);
    assert_eq!(simulation.insert(&[sphere([0.5, 0.0, 0.2], 0.02)]).unwrap(), 1..2);
    simulation.run_quietly(1, ONE).unwrap();
    assert!((along(&simulation) / before - 1.0).abs() < 1e-6, "{} {before}", along(&simulation));
    assert_eq!((simulation.count(), simulation.grains().len()), (2, 2));
    let mut anew = Setup::new(Stuff::BALLAST, vec![simulation.grain(0).unwrap()]);
    anew.walls = vec![Wall::plane([0.0; 3], [0.0, 0.0, 1.0], 0)];
    anew.time_step = TimeStep::Seconds(5e-6);
    let mut anew = Simulation::new(anew).unwrap();
    anew.run_quietly(1, ONE).unwrap();
    assert!(along(&anew).abs() < 0.01 * held, "{}", along(&anew));
}

/// A stone that comes in falls as one does: `z = z0 - g t²/2` in the symplectic scheme, `- g dt² n (n + 1) / 2`. And it lands on
/// the floor, which it could only if lists know it.
#[test]
fn who_comes_in_falls_and_lands() {
    let mut setup = Setup::new(Stuff::BALLAST, vec![sphere([0.0, 0.0, 0.025], 0.025)]);
    setup.walls = vec![Wall::plane([0.0; 3], [0.0, 0.0, 1.0], 0)];
    setup.time_step = TimeStep::Seconds(1e-5);
    let mut simulation = Simulation::new(setup).unwrap();
    simulation.run_quietly(5000, ONE).unwrap();
    simulation.insert(&[sphere([0.2, 0.1, 0.2], 0.03)]).unwrap();
    simulation.run_quietly(10_000, ONE).unwrap();
    let fallen = 9.81 * 1e-10 * 0.5 * 10_000.0 * 10_001.0;
    assert!((simulation.grain(1).unwrap().sphere.centre[2] - (0.2 - fallen)).abs() < 1e-12);
    simulation.run_quietly(90_000, ONE).unwrap();
    assert!((simulation.grain(1).unwrap().sphere.centre[2] - 0.03).abs() < 1e-5);
    assert_eq!(simulation.wall_contacts().len(), 2);
}

/// What cannot come in is refused with its reason, and every bit is as before.
#[test]
fn what_cannot_come_in_changes_nothing() {
    let mut simulation = on_a_slope();
    let before = bits(&simulation);
    type Wanted = fn(&DemError) -> bool;
    let tries: [(Grain, Wanted); 5] = [
        (sphere([0.01, 0.0, 0.06], 0.025), |error| matches!(error, DemError::DeepOverlap { first: 0, second: 1, .. })),
        (sphere([0.3, 0.0, 0.01], 0.025), |error| matches!(error, DemError::DeepInWall { grain: 1, wall: 0, .. })),
        (sphere([0.3, 0.0, 0.3], -0.025), |error| matches!(error, DemError::BadNumber { what: "radius", .. })),
        // The Rayleigh time goes as the radius: 5 µs is that of a stone of 4.8 mm.
        (sphere([0.3, 0.0, 0.3], 0.002), |error| matches!(error, DemError::TimeStepTooLong { .. })),
        (Grain { material: 1, ..sphere([0.3, 0.0, 0.3], 0.025) }, |error| {
            matches!(error, DemError::NoSuchMaterial { material: 1, .. })
        }),
    ];
    for (grain, wanted) in tries {
        let error = simulation.insert(&[grain]).unwrap_err();
        assert!(wanted(&error), "{error}");
        assert_eq!(bits(&simulation), before);
        assert_eq!((simulation.count(), simulation.grains().len()), (1, 1));
    }
    assert_eq!(simulation.insert(&[]).unwrap(), 1..1);
    assert_eq!(bits(&simulation), before);
}

/// Saved after stones came in, loaded and gone on with: the same bits.
#[test]
fn a_break_after_an_insertion_changes_no_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rain.state");
    let rain = |simulation: &mut Simulation, layer: u32| {
        let stones: Vec<Grain> = (0..9)
            .map(|n| {
                let centre = [0.06 * f64::from(n % 3) + 0.003 * f64::from(layer), 0.06 * f64::from(n / 3), 0.3];
                Grain::at_rest(Sphere { centre, radius: 0.02 + 0.001 * f64::from(n) })
            })
            .collect();
        simulation.insert(&stones).unwrap();
    };
    let mut whole = on_a_slope();
    let mut broken = on_a_slope();
    for layer in 0..3 {
        for simulation in [&mut whole, &mut broken] {
            rain(simulation, layer);
            simulation.run_quietly(60_000, ONE).unwrap();
        }
        broken.save(&path).unwrap();
        broken = Simulation::load(&path).unwrap();
    }
    for simulation in [&mut whole, &mut broken] {
        simulation.run_quietly(100_000, ONE).unwrap();
    }
    assert_eq!(whole.count(), 28);
    let touching = whole.contacts().len() + whole.wall_contacts().len();
    assert!(touching > 10, "{touching}");
    assert_eq!(bits(&whole), bits(&broken));
}
