"""Contacts, stops, latches and dry friction against closed forms."""

import numpy as np
import pytest
from scipy.special import ellipk

import zerodrift as zd

G = 9.81
FINE = {"rtol": 1e-10, "atol": 1e-12}


def ball(restitution=0.8, friction=0.0, **start):
    m = zd.Mechanism("ball", gravity=(0, -G))
    body = m.particle("ball", 2.0, at=(0, 1))
    m.contact("floor", body, m.ground.line((0, 0), (1, 0)), restitution=restitution, friction=friction)
    m.start({body.velocity.x: start.get("speed", 0.0)})
    return m


def slider(**friction):
    m = zd.Mechanism("slider", gravity=(0, -G))
    block = m.body("block", 2.0, 0.1)
    slide = m.prismatic("slide", m.ground, block, at=(0, 0), axis=(1, 0), **friction)
    return m, slide


def rocking_block(friction=0.9, tilt=0.1):
    """Housner's block, 0.4 by 1 m, tilted on its left corner."""
    half, height = 0.2, 0.5
    c, s = np.cos(tilt), np.sin(tilt)
    m = zd.Mechanism("block", gravity=(0, -G))
    block = m.body("block", 3.0, (half**2 + height**2), at=(c * half - s * height, s * half + c * height), angle=tilt)
    floor = m.ground.line((0, 0), (1, 0))
    for name, x in (("left", -half), ("right", half)):
        m.contact(name, block.point((x, -height)), floor, friction=friction)
    return m, half, height


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def bounces(restitution, count):
    """Times of the impacts of a ball that falls 1 m."""
    speed, t = np.sqrt(2 * G), [np.sqrt(2 / G)]
    for _ in range(count - 1):
        speed *= restitution
        t.append(t[-1] + 2 * speed / G)
    return np.array(t)


@pytest.mark.parametrize("how", [FINE, {"step": 0.01}, {"step": 0.01, "integrator": "heun"}, {"integrator": "radau", **FINE}],
                         ids=str)
def test_a_ball_bounces_at_the_times_of_the_closed_form_and_comes_to_rest(how):
    sol = zd.simulate(ball(), 5.0, **how)
    assert sol.impacts["t"][:10] == pytest.approx(bounces(0.8, 10), abs=1e-12)     # beyond, rounding of the speed adds up
    rest = np.sqrt(2 / G) * (1 + 2 * 0.8 / (1 - 0.8))
    assert sol.phases[-1].t0 == pytest.approx(rest, abs=1e-5)       # bounces slower than the rest speed, 1e-6 m/s, are left out
    assert sol.phases[-1].state == {"floor": "closed"}
    assert sol["floor.force"][-1] == pytest.approx([0, 2 * G], abs=1e-12)
    assert abs(sol["ball.position"][-1]).max() < 1e-11


@pytest.mark.parametrize("how", [FINE, {"step": 0.01}], ids=str)
def test_bounces_that_are_omitted_are_the_rest_of_a_geometric_series(how):
    e, mass, size = 0.6, 2.0, 1e3       # in a large mechanism, where the rest speed is 1 mm/s
    m = zd.Mechanism("ball", gravity=(0, -G))
    body = m.particle("ball", mass, at=(0, 1))
    m.contact("floor", body, m.ground.line((0, 0), (1, 0)), restitution=e)
    beam = m.link("beam", (0, 0), (size, 0), mass=1.0)
    m.revolute("root", m.ground, beam.start)
    m.revolute("tip", m.ground, beam.end)
    sol = zd.simulate(m, 3.0, **how)
    speed = np.sqrt(2 * G) * e**np.arange(1, 40)
    slow = speed[speed <= 1e-6 * size][0]
    end = np.sqrt(2 / G) * (1 + 2 * e / (1 - e))
    assert sol.stats["omitted_bounce_energy"] == pytest.approx(mass * slow**2 / 2, rel=1e-4)
    assert sol.stats["omitted_bounce_time"] == pytest.approx(2 * slow / G / (1 - e), rel=1e-4)
    assert sol.phases[-1].t0 + sol.stats["omitted_bounce_time"] == pytest.approx(end, abs=1e-7)
    assert sol.impacts["energy_lost"].sum() + sol.stats["omitted_bounce_energy"] == pytest.approx(mass * G, rel=1e-9)
    assert abs(sol.energy_violation).max() < 1e-8


def test_an_impact_loses_its_impulse_times_the_mean_velocity():
    sol = zd.simulate(ball(0.5, 0.3, speed=2.0), 1.0, **FINE)
    first = sol.impacts[0]
    at = np.flatnonzero(sol.t == first["t"])
    kinetic = sol.kinetic_energy[at]
    assert first["impulse"] == pytest.approx(2.0 * 1.5 * np.sqrt(2 * G), rel=1e-12)
    assert kinetic[0] - kinetic[-1] == pytest.approx(first["energy_lost"], rel=1e-12)
    after = max(0, 2.0 - 0.3 * 1.5 * np.sqrt(2 * G))     # by Coulomb's impulse
    assert sol["ball.velocity.x"][at[-1]] == pytest.approx(after, abs=1e-12)
    assert abs(sol.energy_violation).max() < 1e-9


def test_a_pendulum_rebounds_from_a_wall_at_multiples_of_half_its_period():
    m = zd.Mechanism("pendulum", gravity=(0, -G))
    rod = m.link("rod", (0, 0), (0, -1), mass=1.0, inertia=0.0)
    pin = m.revolute("pin", m.ground, rod.start)
    m.stop("wall", pin.angle, lower=0.0, restitution=1.0)
    m.start({pin.angle: 1.0})
    length = 0.5        # of the mathematical pendulum: a rod without inertia about its centre
    quarter = np.sqrt(length / G) * ellipk(np.sin(0.5)**2)
    sol = zd.simulate(m, 12.0, rtol=1e-12, atol=1e-14)
    assert sol.impacts["t"][:10] == pytest.approx(quarter * (1 + 2 * np.arange(10)), abs=2e-10)
    assert sol.impacts["energy_lost"][:10] == pytest.approx(np.zeros(10), abs=1e-12)
    assert sol["wall.torque"][0] == 0
    assert sol[pin.angle].min() > -1e-12


@pytest.mark.parametrize("length", [1e-3, 1.0, 1e3])
def test_a_pendulum_of_any_size_comes_to_rest_on_its_stop(length):
    """The bounces are the same ones: speed e^n v, of which those below 1e-6 rad/s are omitted."""
    m = zd.Mechanism("pendulum", gravity=(0, -G * length))
    rod = m.link("rod", (0, 0), (length, 0), mass=1.0)
    pin = m.revolute("pin", m.ground, rod.start)
    m.stop("stop", pin.angle, lower=-0.1, restitution=0.5)
    sol = zd.simulate(m, 0.5, **FINE)
    bounces = np.log(np.sqrt(3 * G * np.sin(0.1)) / 1e-6) / np.log(2)
    assert abs(len(sol.impacts) - bounces) <= 2
    assert sol.phases[-1].state == {"stop": "closed"}
    assert sol[pin.angle][-1] == pytest.approx(-0.1, abs=1e-14)


def test_a_rocking_block_loses_what_housner_says_and_stops():
    m, half, height = rocking_block()
    sol = zd.simulate(m, 4.0, **FINE)
    ratio = 1 - 1.5 * half**2 / (half**2 + height**2)
    speed = sol["block.angular_velocity"]
    for t in np.unique(sol.impacts["t"])[:6]:
        at = np.flatnonzero(sol.t == t)
        assert speed[at[-1]] == pytest.approx(ratio * speed[at[0]], rel=1e-10)
    assert sol.phases[-1].state == {"left": "sticking", "right": "sticking"}
    assert sol["left.force.y"][-1] + sol["right.force.y"][-1] == pytest.approx(3 * G, rel=1e-12)
    assert abs(speed[-1]) < 1e-12


@pytest.mark.parametrize("friction", [{"friction_force": (2.0, 1.0)}, {"friction": (2.0 / (2 * G), 1.0 / (2 * G))}])
def test_a_block_slides_from_its_static_friction_on_and_sticks_again(friction):
    m, slide = slider(**friction)
    m.motor("push", slide, force=lambda t: 3 * np.sin(t))
    sol = zd.simulate(m, 3.0, **FINE)
    start = np.arcsin(2 / 3)
    assert [phase.state["slide"] for phase in sol.phases] == ["sticking", "sliding"]
    assert sol.phases[1].t0 == pytest.approx(start, abs=1e-10)
    sliding = sol.t > start + 1e-9
    t = sol.t[sliding]
    assert sol[slide.speed][sliding] == pytest.approx((3 * (np.cos(start) - np.cos(t)) - (t - start)) / 2, abs=1e-9)
    assert sol[slide.acceleration][sliding] == pytest.approx((3 * np.sin(t) - 1) / 2, abs=1e-9)
    assert sol["slide.force.x"][sliding] == pytest.approx(3 * np.sin(t) - 1, abs=1e-9)      # of the motor and of friction
    assert sol[slide.speed][~sliding].max() == 0


def test_what_slides_stops_where_its_energy_is_used_up():
    m, slide = slider(friction_force=3.0)
    m.start({slide.speed: 1.0})
    sol = zd.simulate(m, 2.0, **FINE)
    assert sol[slide.displacement][-1] == pytest.approx(1 / 3, abs=1e-9)        # m v^2 / 2 = F x
    assert sol.phases[-1].t0 == pytest.approx(2 / 3, abs=1e-10)
    assert sol.phases[-1].state == {"slide": "sticking"}


def test_friction_that_sticks_is_at_rest_to_the_last_bit():
    m, slide = slider(friction_force=5.0)
    m.motor("push", slide, force=lambda t: 4 * np.sin(3 * t))
    sol = zd.simulate(m, 100.0, step=1e-3, save_every=100)
    assert abs(sol[slide.speed]).max() == 0
    assert abs(sol[slide.displacement]).max() == 0
    assert [str(phase) for phase in sol.phases] == ["0 to 100 s: slide sticking"]


def test_friction_of_a_pin_is_bounded_by_its_load():
    m = zd.Mechanism("pendulum", gravity=(0, -G))
    rod = m.link("rod", (0, 0), (1, 0), mass=1.0)
    pin = m.revolute("pin", m.ground, rod.start, friction=0.3, radius=0.1)
    sol = zd.simulate(m, 20.0, **FINE)
    sliding = abs(sol[pin.speed]) > 1e-6
    load = np.linalg.norm(sol[pin.force], axis=1)
    assert abs(sol[pin.torque][sliding]) == pytest.approx(0.03 * load[sliding], rel=1e-7)
    assert (sol[pin.torque][sliding] * sol[pin.speed][sliding] < 0).all()
    assert sol.phases[-1].state == {"pin": "sticking"}
    assert abs(sol[pin.torque][-1]) <= 0.03 * load[-1] + 1e-12
    assert abs(sol.energy_violation).max() < 1e-7


def test_a_latch_conserves_angular_momentum_and_loses_carnots_energy():
    m = zd.Mechanism("arms")
    a, b = m.link("a", (0, 0), (1, 0), mass=1.0), m.link("b", (1, 0), (1, 1), mass=2.0)
    first, second = m.revolute("first", m.ground, a.start), m.revolute("second", a.end, b.start)
    lock = m.weld("lock", a, b, at=(1, 0), active=False)
    m.latch("pawl", lock, when="second.angle - 0.5")
    m.start({a.angle: 0.0, second.angle: -0.5, second.speed: 2.0, first.speed: -0.3})
    sol = zd.simulate(m, 3.0, **FINE)

    def momentum(i):
        bodies = ((1.0, "a"), (2.0, "b"))
        spin = sum(mass / 12 * sol[f"{name}.angular_velocity"][i] for mass, name in bodies)
        return spin + sum(mass * cross(sol[f"{name}.center.position"][i], sol[f"{name}.center.velocity"][i])
                          for mass, name in bodies)
    impact = sol.impacts[0]
    before, *_, after = np.flatnonzero(sol.t == impact["t"])
    assert momentum(after) == pytest.approx(momentum(before), abs=1e-12)
    assert sol.kinetic_energy[before] - sol.kinetic_energy[after] == pytest.approx(impact["energy_lost"], abs=1e-12)
    assert sol[second.speed][after] == pytest.approx(0, abs=1e-13)
    assert sol[second.angle][-1] == pytest.approx(sol[second.angle][after], abs=1e-10)


def test_a_run_releases_and_joins():
    m = zd.Mechanism("drop", gravity=(0, -G))
    body = m.particle("ball", 1.0, at=(0, 1))
    m.revolute("hook", m.ground, body, active=True)
    run = zd.Run(m, step=0.01, record=True)
    run.step(10)
    run.release("hook")
    run.step(20)
    with pytest.raises(zd.InconsistentStart, match=r"open by 0\.196"):
        run.join("hook")
    run.join("hook", here=True)
    run.step(10)
    sol = run.solution()
    assert run["ball.position.y"] == pytest.approx(1 - G * 0.2**2 / 2, abs=1e-12)
    assert [phase.state["hook"] for phase in sol.phases] == ["joined", "released", "joined"]
    assert sol.impacts["energy_lost"] == pytest.approx([(G * 0.2)**2 / 2], rel=1e-12)
    dropped = zd.simulate(m, 0.5, step=0.01, events=zd.Event(lambda t: t - 0.1, then={"hook": False}))
    assert dropped["ball.position.y"][-1] == pytest.approx(1 - G * 0.4**2 / 2, abs=1e-12)


def test_supports_that_are_redundant_carry_the_block_together():
    m = zd.Mechanism("table", gravity=(0, -G))
    top = m.body("top", 1.0, 0.1, at=(0, 0))
    floor = m.ground.line((0, 0), (1, 0))
    for i, x in enumerate((-0.5, 0.0, 0.5)):
        m.contact(f"foot{i}", top.point((x, 0.0)), floor, friction=0.5)
    sol = zd.simulate(m, 1.0, **FINE)
    assert sum(sol[f"foot{i}.force.y"] for i in range(3)) == pytest.approx(np.full(len(sol.t), G), rel=1e-12)
    assert abs(sol.v).max() < 1e-14


def test_painleves_rod_is_named():
    m = zd.Mechanism("rod", gravity=(0, -G))
    tilt = np.radians(60)
    rod = m.body("rod", 1.0, 1 / 12, at=(0.5 * np.cos(tilt), 0.5 * np.sin(tilt)), angle=tilt)
    m.contact("tip", rod.point((-0.5, 0)), m.ground.line((0, 0), (1, 0)), friction=3.0)
    m.start({rod.velocity.x: -2.0})     # the tip slides ahead of the centre
    with pytest.raises(zd.NoUniqueMotion, match="tip"):
        zd.simulate(m, 1.0)


def test_a_start_that_penetrates_is_named():
    m = zd.Mechanism("deep", gravity=(0, -G))
    body = m.particle("ball", 1.0, at=(0, -0.1))
    m.contact("floor", body, m.ground.line((0, 0), (1, 0)))
    with pytest.raises(zd.InconsistentStart, match="floor"):
        zd.simulate(m, 1.0)


# ---- what else runs ----

def test_states_between_samples_are_those_of_a_finer_record():
    m, *_ = rocking_block()
    coarse, times = zd.simulate(m, 1.0, **FINE), np.linspace(0, 1, 57)
    p, v = coarse(times)
    fine = zd.simulate(m, 1.0, t_eval=times, **FINE)
    assert p == pytest.approx(fine.p, abs=1e-11)
    assert v == pytest.approx(fine.v, abs=1e-9)


def test_ensembles_and_open_runs_have_the_motion_of_single_runs():
    m = ball(0.7, 0.2, speed=1.0)
    runs = zd.ensemble(m, 2.0, parameters={"floor.restitution": [0.7, 0.3]}, step=0.01)
    for i, restitution in enumerate((0.7, 0.3)):
        alone = zd.simulate(m.with_parameters({"floor.restitution": restitution}), 2.0, step=0.01)
        assert (runs[i].p == alone.p).all()
    many = zd.ManyRuns(m, runs=2, step=0.01)
    many.step(200)
    assert (many.p == zd.simulate(m, 2.0, step=0.01).p[-1]).all()


def test_files_keep_contacts_stops_latches_and_friction(tmp_path):
    m, slide = slider(friction=(0.3, 0.2), guide=0.4)
    m.stop("buffer", slide.displacement, lower=-1.0, upper=0.1, restitution=0.4)
    m.contact("floor", m["block"].point((0.0, 0.5)), m.ground.line((0, -3), (1, -3)), friction=(0.5, 0.4), restitution=0.2)
    m.weld("lock", m.ground, m["block"], at=(0, 0), active=False)
    m.latch("pawl", "lock", when="slide.displacement - 0.05", until="(slide.force.x + 2) * 0.5")
    m.start({slide.speed: 2.0})
    again = zd.load(m.save(tmp_path / "m"))
    one, other = zd.simulate(m, 1.0, step=0.01), zd.simulate(again, 1.0, step=0.01)
    assert (one.p == other.p).all()
    assert len(one.phases) > 1
    kept = zd.load(one.save(tmp_path / "sol"))
    assert [str(phase) for phase in kept.phases] == [str(phase) for phase in one.phases]
    assert (kept.impacts == one.impacts).all()


def test_studies_that_know_no_phases_refuse_by_name():
    m = ball()
    for study in (zd.check, lambda m: zd.equilibria(m, "ball.mass", [1.0, 2.0])):
        with pytest.raises((ValueError, zd.ZerodriftError), match="floor"):
            study(m)


def test_arguments_are_refused_by_name():
    m, slide = slider()
    other = zd.Mechanism("other")
    other.body("b", 1.0, 1.0)
    wrong = [(lambda: m.stop("a", slide.displacement), "lower="),
             (lambda: m.stop("a", slide.speed, upper=1.0, restitution=0.5), "rate"),
             (lambda: m.stop("a", slide.displacement, lower=1.0, upper=0.0), "less than upper"),
             (lambda: m.contact("c", m["block"], "floor"), "a shape of a body"),
             (lambda: m.contact("c", m["block"], m.ground.line((0, 0), (1, 0)), restitution=1.2), "at most 1"),
             (lambda: m.contact("c", m["block"], m.ground.line((0, 0), (1, 0)), friction=(0.1, 0.2)), "static"),
             (lambda: m.contact("c", m["block"], other["b"].line((0, 0), (1, 0))), "another mechanism"),
             (lambda: m.contact("c", other["b"], m.ground.line((0, 0), (1, 0))), "another mechanism"),
             (lambda: m.ground.line((0, 0), (0, 0)), "two places"),
             (lambda: m.revolute("r", m.ground, m["block"], at=(1, 1), friction=0.1), "radius="),
             (lambda: m.latch("l", slide, when="slide.displacement"), "active=")]
    for make, said in wrong:
        with pytest.raises((ValueError, TypeError), match=said):
            make()
    m.weld("lock", m.ground, m["block"], at=(0, 0), active=False)
    m.latch("pawl", "lock", when="slide.displacement - sin(1)")
    with pytest.raises(ValueError, match="when of latch 'pawl'"):
        zd.simulate(m, 1.0)


# ---- scales and coincidences ----

@pytest.mark.parametrize("scale", [1e-2, 10.0, 100.0])
def test_bounces_accumulate_alike_at_any_scale(scale):
    def box(scale):
        m = zd.Mechanism("box", gravity=(0, -G * scale))
        body = m.body("box", 1.0, 0.1 * scale**2, at=(0, scale), angle=0.3)
        floor = m.ground.line((0, 0), (scale, 0))
        for name, x in (("left", -0.3), ("right", 0.3)):
            m.contact(name, body.point((x * scale, -0.2 * scale)), floor, restitution=0.3, friction=0.3)
        m.start({body.velocity: (0.5 * scale, 0)})
        return zd.simulate(m, 1.5, rtol=1e-10, atol=1e-14 * scale)
    one, other = box(1.0), box(scale)
    assert other["box.position"][-1] / scale == pytest.approx(one["box.position"][-1], abs=1e-9)


def test_a_machine_with_friction_in_two_joints_comes_to_rest():
    m = zd.Mechanism("engine", gravity=(0, -G))
    crank, rod = m.link("crank", (0, 0), (0.2, 0.1), mass=1.0), m.link("rod", (0.2, 0.1), (0.8, 0), mass=1.0)
    block = m.body("block", 1.0, 0.01, at=(0.8, 0))
    m.revolute("A", m.ground, crank.start, friction=0.1, radius=0.02)
    m.revolute("B", crank.end, rod.start)
    m.revolute("C", rod.end, block)
    m.prismatic("S", m.ground, block, axis=(1, 0), friction=0.2)
    m.start({crank.angular_velocity: 5.0})
    sol = zd.simulate(m, 10.0)
    assert abs(sol.v[-1]).max() < 1e-10
    assert sol.phases[-1].state["S"] == "sticking"


def test_a_slider_that_rests_on_its_stop_stays_there():
    m, slide = slider(friction_force=1.0)
    m.stop("end", slide.displacement, upper=0.1)
    m.motor("push", slide, force=lambda t: 2 * np.sin(t))
    sol = zd.simulate(m, 12.0)
    assert len(sol.phases) < 20
    assert sol[slide.displacement].max() < 0.1 + 1e-12


def test_impacts_on_a_driven_body_keep_the_energy_balance():
    m = zd.Mechanism("table", gravity=(0, -G))
    table = m.body("table", 1.0, 1.0, at=(0, 0))
    lift = m.prismatic("lift", m.ground, table, axis=(0, 1))
    m.motor("drive", lift, displacement=lambda t: 0.02 * np.sin(20 * t))
    grain = m.particle("grain", 1.0, at=(0, 0.3))
    m.contact("contact", grain, table.line((0, 0), (1, 0)), restitution=0.8)
    sol = zd.simulate(m, 3.0, **FINE)
    assert len(sol.impacts) > 5
    assert abs(sol.energy_violation).max() < 1e-7


def test_integrators_without_constraints_on_velocities_refuse_friction():
    m, _ = slider(friction_force=1.0)
    with pytest.raises(zd.UnsuitedIntegrator, match="friction"):
        zd.simulate(m, 1.0, step=0.01, integrator="rattle")


def test_an_event_at_the_instant_of_an_impact_occurs_once():
    m = ball(0.5)
    sol = zd.simulate(m, 1.0, events=zd.Event("ball.position.y"), **FINE)
    assert sol.t_events[0] == pytest.approx(sol.impacts["t"][:len(sol.t_events[0])], abs=1e-9)


# ---- reactions in events, latches and laws ----

STEPS = [FINE, {"step": 0.01}, {"integrator": "radau", **FINE}]


@pytest.mark.parametrize("how", STEPS, ids=str)
def test_events_read_the_force_of_a_contact(how):
    """A ball of 2 kg is lifted by 10 t N: the floor bears 10 N at 0.962 s, and nothing from 1.962 s on."""
    m = zd.Mechanism("lift", gravity=(0, -G))
    body = m.particle("ball", 2.0, at=(0, 0))
    m.contact("floor", body, m.ground.line((0, 0), (1, 0)), friction=0.5)
    m.force("pull", body, along=(0, 1), value=lambda t: 10 * t)
    norm = zd.Event(lambda x, y: np.hypot(x, y), value=10.0, of={"x": "floor.force.x", "y": "floor.force.y"})
    sol = zd.simulate(m, 3.0, events=[zd.Event("floor.force.y", value=10.0), norm, "floor.force.y"], **how)
    for times, expected in zip(sol.t_events, (0.962, 0.962, 1.962), strict=True):
        assert times == pytest.approx([expected], abs=1e-10)


@pytest.mark.parametrize("how", STEPS, ids=str)
def test_events_occur_where_a_change_of_phase_moves_their_function_past_zero(how):
    """The force on a floor jumps from 0 to 19.62 N at the impact, and the velocity from -4.4 m/s to 0: both are passed there."""
    m = zd.Mechanism("drop", gravity=(0, -G))
    body = m.particle("ball", 2.0, at=(0, 1))
    m.contact("floor", body, m.ground.line((0, 0), (1, 0)))
    fall = np.sqrt(2 / G)
    events = [zd.Event("floor.force.y", value=10.0), zd.Event("ball.velocity.y", value=-1.0, direction=1), "ball.velocity.y"]
    sol = zd.simulate(m, 1.0, events=events, **how)
    assert sol.t_events[0] == pytest.approx([fall], abs=1e-12)
    assert sol.t_events[1] == pytest.approx([fall], abs=1e-12)
    assert sol.t_events[2].size == 0        # zero is reached, not passed
    assert zd.simulate(m, 1.0, events=zd.Event("floor.force.y", value=10.0, terminal=True), **how).t[-1] == sol.t_events[0][0]


@pytest.mark.parametrize("how", STEPS[:2], ids=str)
def test_a_latch_lets_go_at_the_load_of_a_rod_and_of_an_impact(how):
    """A rod that falls about its end tears off where its pin bears 20 N, of m g (5 sin a / 2, cos a / 4)."""
    m = zd.Mechanism("rod", gravity=(0, -G))
    rod = m.link("rod", (0, 0), (1, 0), mass=1.0)
    hook = m.revolute("hook", m.ground, rod.start, active=True)
    m.latch("tear", hook, until="hook.force.x * hook.force.x + hook.force.y * hook.force.y - 400")
    sol = zd.simulate(m, 0.6, **how)
    assert [phase.state["hook"] for phase in sol.phases] == ["joined", "released"]
    at = np.flatnonzero(sol.t == sol.phases[1].t0)[0]
    expected = ((20 / G)**2 - 1 / 16) / (6.25 - 1 / 16)
    assert np.sin(sol["rod.angle"][at])**2 == pytest.approx(expected, abs=1e-7 if "step" in how else 1e-10)
    m = zd.Mechanism("drop", gravity=(0, -G))
    crate = m.body("crate", 2.0, 0.1, at=(0, 1))
    m.weld("strap", crate, m.body("load", 1.0, 0.1, at=(0, 1)), at=(0, 1), active=True)
    m.contact("floor", crate.point((0, 0)), m.ground.line((0, 0), (1, 0)))
    m.latch("tear", "strap", until="floor.force.y - 10")
    assert [phase.state["strap"] for phase in zd.simulate(m, 1.0, **how).phases] == ["joined", "joined", "released"]


def test_events_read_joints_with_dry_friction():
    """The force across a slider on which 3 sin(t) acts: friction bears all of it below 2 N, then 1 N."""
    m, slide = slider(friction_force=(2.0, 1.0))
    m.motor("push", slide, force=lambda t: 3 * np.sin(t))
    sol = zd.simulate(m, 3.0, events=[zd.Event("slide.force.x", value=value) for value in (0.5, 1.5)], **FINE)
    start = np.arcsin(2 / 3)        # from 0 to 1 N there
    assert sol.t_events[0] == pytest.approx([start, np.pi - np.arcsin(0.5)], abs=1e-10)
    assert sol.t_events[1] == pytest.approx([np.arcsin(2.5 / 3), np.pi - np.arcsin(2.5 / 3)], abs=1e-10)


@pytest.mark.parametrize(("pull", "speed"), [(1.0, 0.0), (10.0, 0.8)])
def test_friction_beside_a_joint_that_a_weld_holds(pull, speed):
    """The pin has no direction to move in; a slider of no connection with it sticks and slides as without it."""
    m = zd.Mechanism("brake", gravity=(0, -9.81))
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    m.revolute("pin", m.ground, link.start, friction=0.3, radius=0.05)
    m.weld("lock", m.ground, link, at=(0, 0), active=True)
    block = m.body("block", 1.0, 0.1, at=(5, 0))
    m.prismatic("slide", m.ground, block, at=(5, 0), axis=(1, 0), friction_force=2.0)
    m.force("pull", block.point((0, 0)), value=pull, along=(1, 0))
    assert zd.simulate(m, 0.1)["slide.speed"][-1] == pytest.approx(speed, abs=1e-12)
