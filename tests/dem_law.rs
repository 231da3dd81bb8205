//! The law of a contact against closed forms.

mod dem_support;

use ballast_gpr::packing::dem::{Setup, Simulation, Stuff, TimeStep};
use dem_support::{ONE, floor, mass, sphere};

const E: f64 = 17.7e9;
const NU: f64 = 0.18;

fn e_star() -> f64 {
    E / (2.0 * (1.0 - NU * NU))
}

/// Two spheres that fly at each other: duration of the impact and speed apart over speed together.
fn impact(restitution: f64, radii: [f64; 2], speed: f64) -> [f64; 2] {
    let stuff = Stuff { restitution, ..Stuff::BALLAST };
    let mut grains = vec![sphere([0.0; 3], radii[0]), sphere([radii[0] + radii[1] + 1e-5, 0.0, 0.0], radii[1])];
    grains[0].velocity[0] = speed;
    let mut setup = Setup::new(stuff, grains);
    setup.gravity = [0.0; 3];
    setup.time_step = TimeStep::ShareOfRayleigh(0.005);
    let mut simulation = Simulation::new(setup).unwrap();
    let dt = simulation.step_length().seconds;
    let (mut touching, mut after) = (0_u32, false);
    while !after {
        simulation.run_quietly(1, ONE).unwrap();
        if simulation.contacts().is_empty() {
            after = touching > 0;
        } else {
            touching += 1;
        }
    }
    let [a, b] = [0, 1].map(|n| simulation.grain(n).unwrap().velocity[0]);
    let momentum = mass(radii[0]) * a + mass(radii[1]) * b;
    assert!((momentum / (mass(radii[0]) * speed) - 1.0).abs() < 1e-12, "momentum {momentum}");
    [f64::from(touching) * dt, (b - a) / speed]
}

/// Elastic: 2.87 (m*²/(R* E*² v))^(1/5) (Hertz; the number is 2.8683), to 1 % of the rounding of the number and the steps;
/// nothing is lost.
#[test]
fn an_elastic_impact_lasts_as_long_as_hertz_says() {
    for (radii, speed) in [([0.025, 0.025], 1.0), ([0.0125, 0.04], 3.0)] {
        let [m1, m2] = radii.map(mass);
        let (m, r) = (m1 * m2 / (m1 + m2), radii[0] * radii[1] / (radii[0] + radii[1]));
        let wanted = 2.87 * (m * m / (r * e_star().powi(2) * speed)).powf(0.2);
        let [duration, restitution] = impact(1.0, radii, speed);
        assert!((duration / wanted - 1.0).abs() < 0.01, "{duration} for {wanted}");
        assert!((restitution - 1.0).abs() < 1e-3, "{restitution}");
    }
}

/// The fit of Thornton is good to four parts in a thousand.
#[test]
fn an_impact_gives_back_its_restitution() {
    for e in [0.2, 0.4, 0.7, 0.9] {
        let [_, back] = impact(e, [0.025, 0.02], 1.0);
        assert!((back - e).abs() < 4e-3, "{back} for {e}");
    }
}

/// At rest on a floor: (0.75 m g/(E* √R))^(2/3), to 1e-6; E* is that of two equal bodies.
#[test]
fn a_stone_at_rest_is_pressed_in_as_far_as_hertz_says() {
    for radius in [0.0125, 0.025, 0.04] {
        let mut setup = Setup::new(Stuff::BALLAST, vec![sphere([0.0, 0.0, radius], radius)]);
        setup.walls.push(floor());
        setup.time_step = TimeStep::ShareOfRayleigh(0.1);
        let mut simulation = Simulation::new(setup).unwrap();
        simulation.run_quietly(60_000, ONE).unwrap();
        let wanted = (0.75 * mass(radius) * 9.81 / (e_star() * radius.sqrt())).powf(2.0 / 3.0);
        let contacts = simulation.wall_contacts();
        assert_eq!(contacts.len(), 1);
        let overlap = contacts[0].overlap.si();
        assert!((overlap / wanted - 1.0).abs() < 1e-6, "{overlap} for {wanted}");
        let load = &simulation.wall_loads()[0];
        assert!((load.force[2] / (-9.81 * mass(radius)) - 1.0).abs() < 1e-6, "{:?}", load.force);
    }
}

/// A stone on a slope slides above the angle of friction and sticks below; sliding at g (sin β - μ cos β) (rolling held by
/// a friction that is beyond it).
#[test]
fn a_stone_slides_above_the_angle_of_friction() {
    let slide = |degrees: f64| {
        let stuff = Stuff { friction: 0.3, rolling_friction: 5.0, ..Stuff::BALLAST };
        let (sin, cos) = degrees.to_radians().sin_cos();
        let mut setup = Setup::new(stuff, vec![sphere([0.0, 0.0, 0.025], 0.025)]);
        setup.walls.push(floor());
        setup.gravity = [9.81 * sin, 0.0, -9.81 * cos];
        let mut simulation = Simulation::new(setup).unwrap();
        let dt = simulation.step_length().seconds;
        simulation.run_quietly(5000, ONE).unwrap();
        let before = simulation.grain(0).unwrap().velocity[0];
        simulation.run_quietly(5000, ONE).unwrap();
        let after = simulation.grain(0).unwrap();
        assert_eq!(after.spin, [0.0; 3]);
        (after.velocity[0] - before) / (5000.0 * dt)
    };
    // tan 16.70° = 0.3.
    assert!(slide(16.0).abs() < 1e-6);
    let (sin, cos) = 20.0_f64.to_radians().sin_cos();
    let wanted = 9.81 * (sin - 0.3 * cos);
    let found = slide(20.0);
    assert!((found / wanted - 1.0).abs() < 1e-4, "{found} for {wanted}");
}

/// A ball hit off centre keeps its angular momentum about the point of contact while it slides: it ends up rolling at 5/7 of
/// its speed, whatever the friction.
#[test]
fn a_ball_that_slid_rolls_at_five_sevenths_of_its_speed() {
    let stuff = Stuff { friction: 0.2, rolling_friction: 0.0, ..Stuff::BALLAST };
    let mut grain = sphere([0.0, 0.0, 0.025 - 1e-7], 0.025);
    grain.velocity[1] = 0.7;
    let mut setup = Setup::new(stuff, vec![grain]);
    setup.walls.push(floor());
    let mut simulation = Simulation::new(setup).unwrap();
    simulation.run_quietly(60_000, ONE).unwrap();
    let end = simulation.grain(0).unwrap();
    assert!((end.velocity[1] / 0.5 - 1.0).abs() < 1e-3, "{:?}", end.velocity);
    assert!((-end.spin[0] * 0.025 / 0.5 - 1.0).abs() < 1e-3, "{:?}", end.spin);
}
