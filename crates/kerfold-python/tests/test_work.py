"""Work: the lock is free, Ctrl-C and the hook stop it, it is fast enough."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import kerfold
from kerfold import Mesh


def long_work() -> object:
    """Some seconds of work that asks whether it should stop."""
    ball = Mesh.solid("geodesic-12", edge=10)
    return ball.unfold("one", effort=30, sheet="none")


def test_other_threads_run_meanwhile() -> None:
    ticks, is_done = [0], threading.Event()

    def tick() -> None:
        while not is_done.is_set():
            ticks[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    begin = time.perf_counter()
    Mesh.solid("geodesic-8", edge=10).unfold(sheet="none")
    spent = time.perf_counter() - begin
    is_done.set()
    thread.join()
    assert spent < 0.05 or ticks[0] > 5, (spent, ticks)


@pytest.mark.skipif(os.name == "nt", reason="signals are other there")
def test_ctrl_c_stops_work() -> None:
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    begin = time.perf_counter()
    with pytest.raises(KeyboardInterrupt):
        for _ in range(100):
            long_work()
    assert time.perf_counter() - begin < 30
    # And everything works as before.
    assert len(Mesh.solid("cube").faces) == 6


def test_the_hook_hears_of_work_and_stops_it() -> None:
    told: list[tuple[str, int, int]] = []
    kerfold.on_progress(lambda *news: told.append(news))
    try:
        long_work()
        assert told and all(isinstance(work, str) and done >= 0 for work, done, _ in told)

        class Enough(Exception):
            pass

        def stop(work: str, done: int, total: int) -> None:
            raise Enough

        kerfold.on_progress(stop)
        with pytest.raises(Enough):
            for _ in range(100):
                long_work()
    finally:
        kerfold.on_progress(None)


def test_import_is_quick_and_asks_for_nothing_else() -> None:
    text = (
        "import time, sys; t = time.perf_counter(); import kerfold; "
        "print((time.perf_counter() - t) * 1000); "
        "print([m for m in ('numpy', 'trimesh', 'compas', 'rhino3dm', 'shapely', 'ifcopenshell') if m in sys.modules])"
    )
    best = 1e9
    for _ in range(5):
        out = subprocess.run(
            [sys.executable, "-c", text], capture_output=True, text=True, check=True
        )
        spent, others = out.stdout.splitlines()
        assert others == "[]"
        best = min(best, float(spent))
    # A build for tests is slower than the wheel: the limit of the wheel is 100 ms.
    assert best < float(os.environ.get("KERFOLD_IMPORT_MS", "100")), best


def test_a_million_faces_in_and_out() -> None:
    if not os.environ.get("KERFOLD_MILLION"):
        pytest.skip("KERFOLD_MILLION is not set")
    import tracemalloc

    n = 708
    i, j = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    angle, turn = 2 * np.pi * i / n, 2 * np.pi * j / n
    ring = 3 + np.cos(turn)
    vertices = np.stack([ring * np.cos(angle), ring * np.sin(angle), np.sin(turn)], -1)
    vertices = vertices.reshape(-1, 3) * 100
    a, b = i * n + j, i * n + (j + 1) % n
    c, d = ((i + 1) % n) * n + (j + 1) % n, ((i + 1) % n) * n + j
    faces = np.concatenate([np.stack([a, d, c], -1), np.stack([a, c, b], -1)]).reshape(-1, 3)
    assert len(faces) > 1_000_000
    tracemalloc.start()
    begin = time.perf_counter()
    mesh = Mesh(vertices, faces)
    mid = time.perf_counter()
    peak_in = tracemalloc.get_traced_memory()[1]
    tracemalloc.reset_peak()
    out, corners = mesh.vertices, np.asarray(mesh.faces)
    end = time.perf_counter()
    peak_out = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert np.array_equal(out, vertices) and np.array_equal(corners, faces)
    # Python holds nothing of what goes in, and of what comes out the arrays themselves.
    own = vertices.nbytes + faces.nbytes + 8 * len(faces)
    sys.stderr.write(
        f"\n{len(faces)} faces: in {mid - begin:.2f} s (+{peak_in / 1e6:.1f} MB of Python), out "
        f"{end - mid:.2f} s (+{peak_out / 1e6:.1f} MB of {own / 1e6:.1f} MB)\n"
    )
    assert peak_in < 0.1 * own and peak_out < 1.2 * own
