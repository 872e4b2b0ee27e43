"""The core in WebAssembly: its numbers in node are the native core's, to the bit."""

import base64
import functools
import gzip
import json
import re
import shutil
import subprocess

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from analysis.test_reach_of_drives import driven
from browser import Browser, needs_chromium
from few_bodies import touching_bodies, touching_in_space
from support import assert_close, relay
from written_laws import machine_of_laws
from zerodrift._private.rotations import rotation_of
from zerodrift.errors import sentence
from zerodrift.export import wasm
from zerodrift.export.block import choose, written

NODE = shutil.which("node")
pytestmark = pytest.mark.skipif(not NODE, reason="there is no node")
STEPS, LARGEST = 100_000, 285_000       # bytes, packed
FEW = 5_000        # steps in Chromium
SCRIPT = """
import {readFileSync} from "node:fs";
import * as zd from "./core.mjs";
const core = await zd.load(readFileSync("core.wasm"));
const tell = (value) => console.log(JSON.stringify(value));
const bits = (array) => Array.from(new BigUint64Array(Float64Array.from(array).buffer), String);
const block = (name) => readFileSync(name);
"""


@pytest.fixture(scope="module")
def web(tmp_path_factory):
    """Function that runs a script in node on blocks, and returns the objects that it tells."""
    pytest.importorskip("ziglang")
    folder = tmp_path_factory.mktemp("web")
    (folder / "core.wasm").write_bytes(wasm.core())
    (folder / "core.mjs").write_text(wasm.text("core.js"))

    def run(script, **blocks):
        for name, data in blocks.items():
            (folder / name).write_bytes(data)
        (folder / "main.mjs").write_text(SCRIPT + script)
        result = subprocess.run([NODE, "main.mjs"], cwd=folder, capture_output=True, text=True, check=False, timeout=tol.HUNG)
        assert result.returncode == 0, result.stderr
        return [json.loads(line) for line in result.stdout.splitlines()]

    return run


def bits(array):
    return [str(word) for word in np.ascontiguousarray(array, dtype=float).reshape(-1).view(np.uint64)]


def test_it_is_small_enough(web):
    assert len(gzip.compress(wasm.core(), 9)) < LARGEST


def driven_slider_crank():
    """A slider-crank whose crank a motor turns."""
    m = zd.Mechanism("driven slider-crank", gravity=(0, -9.81))
    crank = m.link("crank", (0, 0), (0.2, 0.3), mass=1.0)
    rod = m.link("rod", (0.2, 0.3), (1.2, 0), mass=0.8)
    m.revolute("main", m.ground.point((0, 0)), crank.start)
    m.revolute("pin", crank.end, rod.start)
    m.slot("guide", m.ground, rod.end, axis=(1, 0))
    m.motor("drive", "main", speed=6.0)
    return m


MODELS = {zd.models.four_bar: (1e-3, STEPS), zd.models.slider_crank: (1e-3, STEPS), zd.models.jansen: (1e-4, STEPS),
          zd.models.rolling_disc: (1e-4, STEPS), driven_slider_crank: (1e-3, FEW)}      # step, number of steps


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.__name__)
def test_runs_have_the_bits_of_the_native_core(web, model):
    step, steps = MODELS[model]
    found, = web(f"const m = zd.create(core, block('it')); zd.step(m, {steps});"
                 "tell([bits(zd.positions(m)), bits(zd.velocities(m))]);", it=zd.block(model(), step=step, outputs=[]))
    run = zd.Run(model(), step=step, closed_form=False, vector="baseline")
    run.step(steps)
    assert found == [bits(run.p), bits(run.v)]


def test_recorded_functions_have_the_digits_of_the_native_core(web):
    """The C library is another one there."""
    m, names = machine_of_laws()
    found, = web(f"const m = zd.create(core, block('it')); zd.step(m, 30); tell({names}.map((name) => zd.read(m, name)[0]));",
                 it=zd.block(m, step=1e-2, outputs=[]))
    sol = zd.simulate(m, 0.3, step=1e-2, outputs=names, vector="baseline", closed_form=False)
    for name, value in zip(names, found, strict=True):
        assert_close(value, sol[name][-1], 1e-13, scale=1.0, what=name)


def test_events_set_inputs(web):
    m, events = relay()
    found, = web("const m = zd.create(core, block('it')); zd.advance(m, 5);"
                 "tell([bits(zd.positions(m)), zd.input(m, 'drive.torque')]);",
                 it=zd.block(m, step=0.01, outputs=[], events=events))
    sol = zd.simulate(m, 5.0, step=0.01, events=events, closed_form=False, vector="baseline")
    assert found == [bits(sol.p[-1]), -1.0]


@pytest.mark.parametrize(("scene", "end"), [(touching_bodies, 3.0), (touching_in_space, 0.6)])
def test_contacts_have_the_bits_of_the_native_core(web, scene, end):
    m, names = scene()
    found, = web(f"const m = zd.create(core, block('it')); zd.advance(m, {end});"
                 f"tell([bits(zd.positions(m)), bits(zd.velocities(m)), {names}.map((name) => Array.from(zd.read(m, name))),"
                 "zd.violation(m) < 1e-12]);", it=zd.block(m, step=1e-2, outputs=names))
    sol = zd.simulate(m, end, step=1e-2, outputs=names, vector="baseline", closed_form=False)
    forces = [np.atleast_1d(sol[name][-1]).tolist() for name in names]
    assert found == [bits(sol.p[-1]), bits(sol.v[-1]), forces, True]


@needs_chromium
def test_runs_have_the_bits_of_the_native_core_in_chromium(web, tmp_path):
    blocks = {model: base64.b64encode(zd.block(model(), step=step, outputs=[])).decode() for model, (step, _) in MODELS.items()}
    names = ", ".join(re.findall(r"^export (?:async )?function (\w+)", wasm.text("core.js"), re.MULTILINE))
    script = re.sub(r"^export ", "", wasm.text("core.js"), flags=re.MULTILINE)
    core = base64.b64encode(wasm.core()).decode()
    (tmp_path / "core.html").write_text(f"""<link rel="icon" href="data:,"><script type="module">{script}
        const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
        globalThis.core = load(bytes("{core}"));
        globalThis.zd = {{{names}, bytes, bits: (array) => Array.from(new BigUint64Array(array.buffer), String)}};</script>""")
    with Browser(tmp_path / "profile") as browser:
        browser.open((tmp_path / "core.html").as_uri())
        for model, (step, _) in MODELS.items():
            found = browser.evaluate(f"""(async () => {{
                const m = zd.create(await core, zd.bytes("{blocks[model]}"));
                zd.step(m, {FEW});
                return [zd.bits(zd.positions(m)), zd.bits(zd.velocities(m))]; }})()""")
            run = zd.Run(model(), step=step, closed_form=False, vector="baseline")
            run.step(FEW)
            assert found == [bits(run.p), bits(run.v)], model
        assert browser.errors == []


def test_parameters_are_changed_in_the_phase_of_the_moment(web):
    """A sling made longer while its projectile slides; a heavier arm after the sling has let go, which stays released."""
    outputs = ["arm.start.position", "projectile.position"]
    data = zd.block(zd.models.trebuchet(), step=5e-3, outputs=outputs, parameters={"sling.length": (2, 4), "arm.mass": (10, 20)})
    found = web(f"""
        const m = zd.create(core, block("it")), show = () => tell({outputs}.map((name) => Array.from(zd.read(m, name))));
        zd.step(m, 40);
        zd.setParameter(m, "sling.length", 3.0);
        show();
        zd.step(m, 240);
        show();
        zd.setParameter(m, "arm.mass", 18);
        zd.step(m, 40);
        show();
        """, it=data)
    lengths = [np.hypot(*np.subtract(*each)) for each in found]
    assert lengths[0] == pytest.approx(3.0, abs=1e-12)
    assert found[0][1][1] == pytest.approx(0.0, abs=1e-12)
    assert lengths[2] > lengths[1] > 4


def test_a_saved_run_goes_on_with_the_same_bits(web):
    data = zd.block(zd.models.four_bar(), step=1e-3, parameters={"coupler.length": (0.8, 1.3)})
    other = zd.block(zd.models.jansen(), step=1e-3, outputs=[])
    same, *told = web("""
        const m = zd.create(core, block("bar"));
        zd.setParameter(m, "coupler.length", 1.05);
        zd.step(m, 137);
        const saved = zd.saveRun(m);
        zd.step(m, 211);
        const end = [bits(zd.positions(m)), bits(zd.velocities(m))].join();
        const another = zd.create(core, block("bar"));
        zd.step(another, 5);
        for (const each of [m, another]) zd.restoreRun(each, saved);
        const found = [m, another].map((each) => {
          zd.energyViolation(each);
          zd.step(each, 211);
          return [bits(zd.positions(each)), bits(zd.velocities(each))].join() === end;
        });
        tell([...found, zd.parameter(another, "coupler.length"), zd.time(another)]);
        const changed = saved.slice();
        changed[5000] ^= 1;
        const leg = zd.create(core, block("other"));
        const wrong = [[m, saved.slice(0, 20)], [m, saved.slice(0, -4)], [m, changed], [leg, saved]];
        for (const [mechanism, state] of wrong)
          try { zd.restoreRun(mechanism, state); tell(""); } catch (error) { tell(error.message); }
    """, bar=data, other=other)
    assert same == [True, True, 1.05, pytest.approx(0.348)]
    not_integer = "a saved run must be whole: some of its bytes are missing or changed"
    assert told == ["a saved run must begin with zdwm and its version", not_integer, not_integer,
                    "a saved run must be of the same block"]


def test_inputs_measures_parameters_and_states(web):
    bar = zd.models.four_bar()
    data = zd.block(bar, step=1e-3, parameters={"coupler.length": (0.8, 1.3)})
    told = web("""
        const m = zd.create(core, block("bar"));
        tell([m.constraints, zd.freedoms(m), zd.unit(m, "crank.angular_velocity")]);
        zd.step(m, 100);
        const state = JSON.parse(JSON.stringify(zd.save(m)));
        zd.advance(m, 0.2);
        const there = bits(zd.positions(m));
        zd.restore(m, state);
        zd.step(m, 100);
        tell([there.join() === bits(zd.positions(m)).join(), zd.time(m)]);
        zd.setParameter(m, "coupler.length", 0.95);
        const [ax, ay] = zd.read(m, "coupler.start.position"), [bx, by] = zd.read(m, "coupler.end.position");
        tell([Math.hypot(bx - ax, by - ay), zd.parameter(m, "coupler.length"), zd.time(m)]);
        for (const wrong of [() => zd.setParameter(m, "coupler.length", 9), () => zd.read(m, "no"), () => zd.advance(m, 0),
                             () => zd.create(core, new Uint8Array(16))])
          try { wrong(); tell(""); } catch (error) { tell(error.message); }
        zd.step(m, 10);
        tell([zd.time(m), zd.violation(m)]);
        const end = zd.read(m, "coupler.end.position"), goal = [end[0] - 0.05, end[1]];
        const far = Math.hypot(...zd.read(m, "coupler.end.position").map((x, i) => x - goal[i]));
        let left;
        for (let i = 0; i < 30; i++) left = zd.pull(m, "coupler.end.position", goal);
        tell([far, left, zd.violation(m)]);
        zd.close(m);
    """, bar=data)
    system = bar.system()
    assert told[0] == [[each.name for each in system.constraints], {"freedoms": 1, "rank": 2, "redundant": []}, "rad/s"]
    assert told[1][0] is True
    assert told[1][1] == pytest.approx(0.2, abs=1e-12)
    assert told[2] == pytest.approx([0.95, 0.95, 0.2], abs=1e-10)
    assert "be in its range" in told[3]
    assert told[4].startswith("there is no measure no; there are ")
    assert told[5] == "the time must not be before the present one"
    assert "a block must have at least" in told[6]
    assert told[7] == [pytest.approx(0.21, abs=1e-12), pytest.approx(0, abs=1e-11)]
    far, left, violation = told[8]
    assert left < 0.5 * far     # the point moves on a circle, which does not pass through the goal
    assert violation < 1e-11


def test_a_redundant_constraint_is_named(web):
    m = zd.Mechanism("double")
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    m.revolute("left", m.ground, link.start)
    m.revolute("right", m.ground, link.end)
    told, = web("tell(zd.freedoms(zd.create(core, block('m'))));", m=zd.block(m.system("absolute"), step=1e-3, outputs=[]))
    assert told["freedoms"] == 0
    assert told["rank"] == 3
    assert len(told["redundant"]) == 1
    assert told["redundant"][0].partition(".")[0] in ("left", "right")


# Models, coordinates, and a length with the part of it with which a loop cannot close.
OPEN = {"watt": (zd.models.watt, "joint", "right.length", 0.5), "no tree": (zd.models.watt, "absolute", "left.length", 5.0),
        "press": (zd.models.toggle_press, "joint", "rod.length", 0.2),
        "six links": (zd.models.stephenson, "joint", "link.length", 5.0),
        "bennett": (zd.models.bennett, "absolute", "input.length", 0.5),
        "delta": (zd.models.delta_robot, "joint", "left 0.length", 2.0),
        "rssp": (zd.models.spatial_slider_crank, "joint", "rod.length", 0.2)}


def test_a_length_that_cannot_close_is_refused_in_the_words_of_python(web):
    """At the start and in motion, after which the mechanism goes on with its own length."""
    blocks, values, systems = {}, {}, []
    for name, (model, coordinates, length, part) in OPEN.items():
        system = model().system(coordinates)
        systems.append(system)
        drawn = system.parameters[length]
        values[name] = [length, part * drawn, drawn]
        blocks[name] = zd.block(system, step=1e-3, outputs=[], parameters={length: tuple(sorted((drawn, part * drawn)))})
    told = web(f"""
        for (const [name, [length, value]] of Object.entries({json.dumps(values)})) {{
          const m = zd.create(core, block(name)), found = [];
          for (const steps of [0, 20]) {{
            zd.step(m, steps);
            try {{ zd.setParameter(m, length, value); }} catch (error) {{ found.push(error.message); }}
          }}
          zd.step(m, 5);
          tell([name, ...found, zd.parameter(m, length), zd.time(m)]);
        }}""", **blocks)
    for (name, *found, value, t), system in zip(told, systems, strict=True):
        with pytest.raises(zd.CorrectionFailed) as refusal:
            system._with(dict([values[name][:2]])).start_at(0.0)
        assert found == [sentence(refusal.value)] * 2, name
        assert [value, t] == [values[name][2], pytest.approx(0.025)], name


GRIP = """
    const m = zd.create(core, block("it"), 0), axes = ["x", "y", "z"].filter((axis) => m.inputs.includes(`grip.force.${axis}`));
    zd.setParameter(m, "grip.body", BODY);
    axes.forEach((axis, k) => { zd.setParameter(m, `grip.${axis}`, POINT[k]); zd.setInput(m, `grip.force.${axis}`, FORCE[k]); });
    zd.step(m, 200);
    tell([[...zd.positions(m)], [...zd.poses(m)]]);
"""


@pytest.mark.parametrize(("model", "link", "force"), [
    (zd.models.four_bar, "coupler", (0.3, -0.5)), (functools.partial(zd.models.chain, 2), "link 1", (0.3, -0.5, 0.7))])
def test_a_grip_is_a_force_on_a_point_of_a_body(web, model, link, force):
    """As the force of the mechanism itself; poses are those of the native core."""
    loaded, start = model(), zd.simulate(model(), 1e-3, step=1e-3)
    number = [body.name for body in start.system._drawing.parts()].index(link)
    at, R = placed(start.system._first_core.poses(start.p[0])[0][number])
    point = R.T @ (start[f"{link}.end.position"][0] - at)
    block = written(choose(start.system, None, None, 0.0, 1e-3, [], [])._replace(has_grip=True))
    script = GRIP.replace("BODY", str(number + 1)).replace("POINT", str(point.tolist())).replace("FORCE", str(list(force)))
    (p, poses), = web(script, it=block)
    loaded.force("load", f"{link}.end", value=force)
    sol = zd.simulate(loaded, 0.2, step=1e-3, closed_form=False, vector="baseline")
    np.testing.assert_allclose(p, sol.p[-1], atol=1e-9)         # the projections of the grip's parameters
    native = start.system._first_core.poses(np.array(p))[0]
    expected = native if len(force) == 2 else [[*at, *R.T.ravel()] for at, R in map(placed, native)]
    np.testing.assert_allclose(poses, np.ravel(expected), atol=1e-12)


def placed(pose):
    """Mass centre and rotation of a pose."""
    if len(pose) == 7:
        return pose[:3], rotation_of(pose[3:])
    return pose[:2], np.array([[np.cos(pose[2]), -np.sin(pose[2])], [np.sin(pose[2]), np.cos(pose[2])]])


@pytest.mark.parametrize("space", [False, True], ids=["plane", "space"])
def test_a_drive_beyond_its_reach_is_named_in_the_words_of_python(web, space):
    """Also if its speed is an input, so that it prescribes velocities alone; the run stays where it was, and says it again."""
    with pytest.raises(zd.CorrectionFailed) as refusal:
        zd.simulate(driven(space), 1.0, step=1e-3)
    blocks = {name: zd.block(driven(space), step=1e-3, outputs=["A.angle"], inputs=inputs)
              for name, inputs in {"number": [], "input": ["drive.speed"]}.items()}
    told = web("""
        for (const name of ["number", "input"]) {
          const m = zd.create(core, block(name));
          for (const steps of [1000, 5])
            try { zd.step(m, steps); tell(""); } catch (error) { tell([zd.time(m), error.message]); }
        }
    """, **blocks)
    assert told == [[pytest.approx(0.395), sentence(refusal.value)]] * 4


def test_a_length_that_the_drives_do_not_allow_is_refused_by_their_names_and_others_are_reached(web):
    """The end of the crank is 0.3 m above the guide: a shorter rod could close with the crank further down alone."""
    data = zd.block(driven_slider_crank(), step=1e-3, outputs=[], parameters={"rod.length": (0.1, 4.0)})
    told = web("""
        const m = zd.create(core, block("it"));
        for (const length of [0.31, 3.9, 0.29, 0.305, 0.2])
          try { zd.setParameter(m, "rod.length", length); tell(zd.violation(m)); } catch (error) { tell(error.message); }
    """, it=data)
    refused_by_drive = "drives and couplings must be possible with these values: the nearest positions miss 'drive' by "
    assert [each.startswith(refused_by_drive) if isinstance(each, str) else each < 1e-11 for each in told] == [True] * 5
    assert [isinstance(each, str) for each in told] == [False, False, True, False, True]
