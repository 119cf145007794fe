# SPDX-License-Identifier: Apache-2.0
"""Renders and sessions: progress, threads, interrupts, surroundings."""

import _thread
import gc
import multiprocessing
import signal
import threading
import time

import numpy as np
import pytest

import vernier
from conftest import SCENES

SIZE = (48, 32)


def test_pixels_are_the_pictures_own_memory(cornell):
    image = vernier.render(cornell, size=SIZE, spp=2, aov=["depth"])
    pixels, depth = image.pixels, image.layers["depth"]
    assert pixels.shape == (32, 48, 3) and pixels.dtype == np.float32
    assert depth.shape == (32, 48)
    assert np.may_share_memory(pixels, image.pixels)
    assert not pixels.flags.owndata and not pixels.flags.writeable
    before = pixels.copy()
    del image
    gc.collect()
    vernier.render(cornell, size=SIZE, spp=2, seed=1)  # would take memory that was let go
    assert np.array_equal(pixels, before)


def test_error_is_what_a_reference_says(cornell):
    image = vernier.render(cornell, size=SIZE, error=0.3)
    assert image.stats["stopped_by"] == "error"
    assert image.error.low < float(image.error) < image.error.high <= 0.33
    assert image.error_interval == (image.error.low, image.error.high)
    truth = vernier.render(cornell, size=SIZE, spp=400, seed=1)
    actual = vernier.compare(image, truth)["relmse"]**0.5
    assert 0.8 * image.error.low < actual < 1.2 * image.error.high


def test_missing_light_is_told(cornell):
    assert vernier.render(cornell, size=SIZE, spp=4).missing.depth.share < 0.01
    assert vernier.render(cornell, size=SIZE, spp=4, max_depth=2).missing.depth.share > 0.05


def test_progress_is_told_on_the_calling_thread(cornell):
    told = []
    vernier.render(cornell, size=(160, 120), time=0.6,
                   progress=lambda state: told.append((threading.current_thread(), state)))
    assert {thread for thread, _ in told} == {threading.current_thread()}
    states = [state for _, state in told]
    assert all(0 <= state.fraction <= 1 for state in states)
    assert [state.seconds for state in states] == sorted(state.seconds for state in states)


def test_what_progress_raises_ends_the_render(cornell):
    session = vernier.Session(cornell, size=(160, 120))

    def refuse(state):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        session.run(time=60, progress=refuse)
    assert session.samples_per_pixel > 0
    assert session.image().metadata["vernier:stoppedBy"] == "interrupted"


def test_a_session_takes_one_call_at_a_time(cornell):
    session = vernier.Session(cornell, size=(160, 120))
    with pytest.raises(vernier.UsageError, match="in use by another thread"):
        session.run(time=60, progress=lambda state: session.image())


@pytest.fixture
def interruptible():
    """Ctrl-C is heard, which a shell has children in the background ignore."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_interrupt_leaves_a_session_that_goes_on_to_the_same_bytes(spheres, interruptible):
    session = vernier.Session(spheres, size=(160, 120))
    threading.Timer(0.4, _thread.interrupt_main).start()  # what Ctrl-C does
    started = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        session.run(time=60)
    assert time.monotonic() - started < 20
    done = session.samples_per_pixel
    assert done > 0
    spp = 4 * int(done) + 16  # beyond what any tile of the pass that was cut has done
    session.run(spp=spp)
    straight = vernier.render(spheres, size=(160, 120), spp=spp)
    assert session.image().pixels.tobytes() == straight.pixels.tobytes()


def test_other_threads_of_python_run_meanwhile(cornell):
    counted = []
    stop = threading.Event()

    def count():
        while not stop.wait(0.005):
            counted.append(1)

    thread = threading.Thread(target=count)
    thread.start()
    vernier.render(cornell, size=(160, 120), time=0.5)
    stop.set()
    thread.join()
    assert len(counted) > 10


def test_several_sessions_run_at_once(spheres):
    expected = [vernier.render(spheres, size=SIZE, spp=4, seed=seed, env=env).pixels.tobytes()
                for seed, env in enumerate(("sky", "studio", "sky"))]
    found = [b""] * 3

    def work(seed, env):
        found[seed] = vernier.render(spheres, size=SIZE, spp=4, seed=seed, env=env).pixels.tobytes()

    threads = [threading.Thread(target=work, args=pair) for pair in enumerate(("sky", "studio", "sky"))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == expected


def test_any_number_of_threads_gives_the_same_bytes(spheres):
    one, three = (vernier.render(spheres, size=SIZE, spp=4, threads=threads, aov="all") for threads in (1, 3))
    assert one.pixels.tobytes() == three.pixels.tobytes()
    assert {name: values.tobytes() for name, values in one.layers.items()} == {
        name: values.tobytes() for name, values in three.layers.items()}


def test_session_goes_on_from_a_file(cornell, tmp_path):
    session = vernier.Session(cornell, size=SIZE, seed=3)
    session.run(spp=4)
    session.save(tmp_path / "a.ckpt")
    other = vernier.Session(cornell, size=SIZE, seed=3)
    other.load(tmp_path / "a.ckpt")
    for each in (session, other):
        each.run(spp=8)
    assert session.image().pixels.tobytes() == other.image().pixels.tobytes()
    assert session.error == other.error
    with pytest.raises(vernier.InputError, match="seed"):
        vernier.Session(cornell, size=SIZE, seed=4).load(tmp_path / "a.ckpt")


def test_merge_is_of_all_samples(cornell, tmp_path):
    files, images = [], []
    for seed in (1, 2):
        session = vernier.Session(cornell, size=SIZE, seed=seed, adaptive=False)
        session.run(spp=8)
        files.append(tmp_path / f"{seed}.ckpt")
        session.save(files[-1])
        images.append(session.image())
    merged = vernier.merge(files, aov=["error"])
    assert merged.stats["samples_per_pixel"] == 16
    assert np.allclose(merged.pixels, (images[0].pixels + images[1].pixels) / 2, rtol=1e-5)
    assert merged.error.rel_rmse < min(image.error.rel_rmse for image in images)
    assert merged.layers["error"].shape == (32, 48, 3)


def test_sessions_keep_their_surroundings(spheres):
    """Other renders of the scene do not change what a session has begun under."""
    session = vernier.Session(spheres, size=SIZE, env="sky")
    session.run(spp=2)
    dark = vernier.render(spheres, size=SIZE, spp=2, env="none")
    session.run(spp=4)
    fresh = vernier.render(vernier.load(SCENES / "two_spheres.gltf"), size=SIZE, spp=4, env="sky")
    assert session.image().pixels.tobytes() == fresh.pixels.tobytes()
    assert dark.pixels.mean() < fresh.pixels.mean()


def test_surroundings_of_an_array_are_read_anew(make_square):
    scene = vernier.load(make_square())
    sky = np.full((4, 8, 3), 0.5, np.float32)
    image = vernier.render(scene, size=SIZE, spp=4, env=sky)
    doubled = vernier.render(scene, size=SIZE, spp=4, env=sky, env_scale=2)
    assert np.allclose(doubled.pixels, 2 * image.pixels, rtol=1e-5)
    sky *= 2
    assert np.array_equal(vernier.render(scene, size=SIZE, spp=4, env=sky).pixels, doubled.pixels)


def test_dark_scenes_get_a_studio_and_say_so(make_square, caplog):
    caplog.set_level("INFO", logger="vernier")
    scene = vernier.load(make_square())
    image = vernier.render(scene, size=SIZE, spp=2)
    assert image.stats["surroundings"] == "studio"
    assert "studio" in image.notices[0].text
    assert "adding a studio" in caplog.text
    assert vernier.render(scene, size=SIZE, spp=2, env="none").pixels.max() == 0


def test_unknown_settings_are_refused(cornell):
    with pytest.raises(vernier.UsageError, match="unknown setting 'sise'; did you mean 'size'"):
        vernier.render(cornell, sise=SIZE)
    for settings in ({"size": (0, 4)}, {"size": (4.5, 4)}, {"seed": -1}, {"background": (1, 2)}, {"env_scale": 2},
                     {"camera": 1}, {"spp": -1}, {"threads": -2}, {"error": -0.1}):
        with pytest.raises(vernier.UsageError):
            vernier.render(cornell, **{"size": SIZE, **settings})


def render_bytes(queue):
    scene = vernier.load(SCENES / "cornell_box.gltf")
    queue.put(vernier.render(scene, size=SIZE, spp=2).pixels.tobytes())


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_other_processes_render_too(method, cornell):
    own = vernier.render(cornell, size=SIZE, spp=2)
    context = multiprocessing.get_context(method)
    queue = context.Queue()
    process = context.Process(target=render_bytes, args=(queue,))
    process.start()
    try:
        assert queue.get(timeout=120) == own.pixels.tobytes()
    finally:
        process.terminate()
        process.join()
