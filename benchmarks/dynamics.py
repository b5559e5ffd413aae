"""Base parameters of TALOS and their deviations: plantar against Pinocchio + SciPy and against figaroh.

Every contender runs in a process of its own on the same random samples: time is the best of a few runs, memory is what
the process grew by above its imports and the samples' arrays. Agreement is of predictions on other samples.

    python benchmarks/dynamics.py [--samples 5000] [--figaroh PYTHON] [--stream 1000000]

`--figaroh` names a Python that has figaroh 1.0.2 and Pinocchio installed; it is left out where none is given.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

TALOS = Path(pin.__file__).parents[4] / "share/example-robot-data/robots/talos_data/robots/talos_reduced.urdf"
NOISE = 0.5  # N and N.m
CHUNK = 5000
Arrays = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


def talos(urdf: str) -> pin.Model:
    return pin.buildModelFromUrdf(urdf, pin.JointModelFreeFlyer())


def samples(model: pin.Model, count: int, seed: int = 0) -> Arrays:
    """Random q, v, a, and torques of the model's own parameters with noise."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(-1, 1, (count, model.nq))
    q[:, 3:7] /= np.linalg.norm(q[:, 3:7], axis=1, keepdims=True)
    v, a = rng.normal(size=(2, count, model.nv))
    data = model.createData()
    tau = np.array([pin.rnea(model, data, *sample) for sample in zip(q, v, a, strict=True)])
    return q, v, a, tau + rng.normal(0, NOISE, tau.shape)


def plantar(model: pin.Model, arrays: Arrays, rows: str) -> tuple[int, Callable[..., np.ndarray]]:
    from plantar.dynamics import fit_base_parameters

    fit = fit_base_parameters(model, *arrays, rows=rows)  # type: ignore[arg-type]
    assert np.isfinite(fit.std).all()
    return fit.rank, fit.predict


def stacked(model: pin.Model, arrays: Arrays, rows: str) -> np.ndarray:
    q, v, a, _ = arrays
    data = model.createData()
    taken = 6 if rows == "base" else model.nv
    y = np.empty((len(q), taken, 10 * (model.njoints - 1)))
    for i in range(len(q)):
        y[i] = pin.computeJointTorqueRegressor(model, data, q[i], v[i], a[i])[:taken]
    return y.reshape(-1, y.shape[2])


def scipy_qr(model: pin.Model, arrays: Arrays, rows: str) -> tuple[int, Callable[..., np.ndarray]]:
    """QR of the stacked regressor, base columns by a pivoted QR of its small R, values and deviations."""
    from scipy import linalg

    y, tau = stacked(model, arrays, rows), arrays[3][:, : 6 if rows == "base" else model.nv].ravel()
    unitary, r = linalg.qr(y, mode="economic", overwrite_a=True, check_finite=False)
    return _solved(model, rows, r, unitary.T @ tau, float(tau @ tau), len(tau))


def scipy_r(model: pin.Model, arrays: Arrays, rows: str) -> tuple[int, Callable[..., np.ndarray]]:
    """As above, but with the torque as one more column and Q never formed."""
    from scipy import linalg

    y, tau = stacked(model, arrays, rows), arrays[3][:, : 6 if rows == "base" else model.nv].ravel()
    whole = np.asfortranarray(np.column_stack([y, tau]))
    (r,) = linalg.qr(whole, mode="r", overwrite_a=True, check_finite=False)
    width = y.shape[1]
    return _solved(model, rows, r[:width, :width], r[:width, -1], float(tau @ tau), len(tau))


def _solved(
    model: pin.Model, rows: str, r: Any, z: Any, square: float, count: int
) -> tuple[int, Callable[..., Any]]:
    from scipy import linalg

    _, pivoted, order = linalg.qr(r, pivoting=True)
    rank = int(np.sum(np.abs(np.diag(pivoted)) > 1e-9 * abs(pivoted[0, 0])))
    kept = np.sort(order[:rank])
    unitary, base = linalg.qr(r[:, kept], mode="economic")
    values = linalg.solve_triangular(base, unitary.T @ z)
    variance = (square - float(np.sum((unitary.T @ z) ** 2))) / (count - rank)
    inverse = linalg.solve_triangular(base, np.eye(rank))
    std = np.sqrt(variance * np.sum(inverse**2, axis=1))
    assert np.isfinite(std).all()

    def predict(q: Any, v: Any, a: Any) -> Any:
        y = stacked(model, (q, v, a, q), rows)
        return (y[:, kept] @ values).reshape(len(q), -1)

    return rank, predict


def figaroh(model: pin.Model, arrays: Arrays, rows: str) -> tuple[int, Callable[..., np.ndarray]]:
    """figaroh's own regressor, elimination, QR and deviations, as its examples chain them."""
    from types import SimpleNamespace

    from figaroh.identification.identification_tools import relative_stdev
    from figaroh.tools.qrdecomposition import QRDecomposer
    from figaroh.tools.regressor import build_regressor_basic, build_regressor_reduced, get_index_eliminate

    q, v, a, tau = arrays
    config = {
        "is_joint_torques": False,
        "is_external_wrench": True,
        "force_torque": ["Fx", "Fy", "Fz", "Mx", "My", "Mz"],
        "act_idxv": [],
    }
    robot = SimpleNamespace(model=model, data=model.createData())
    names = {f"{p}{k}": 0.0 for k in range(model.njoints - 1) for p in range(10)}
    y = build_regressor_basic(robot, q, v, a, config)
    gone, left = get_index_eliminate(y, names)
    measured = tau[:, :6].T.ravel()
    y_base, found = QRDecomposer().decompose_with_pivoting(measured, build_regressor_reduced(y, gone), left)
    relative_stdev(y_base, np.array(list(found.values())), measured)
    return len(found), lambda q, v, a: np.zeros((len(q), 0))


CONTENDERS = {"plantar": plantar, "scipy": scipy_qr, "scipy-r": scipy_r, "figaroh": figaroh}


def peak() -> float:
    """Largest resident size of this process so far [MB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def work(arguments: argparse.Namespace) -> dict[str, Any]:
    """One contender in this process."""
    model = talos(arguments.urdf)
    other = samples(model, 50, 9)
    few = samples(model, 60, 8)
    runner = CONTENDERS[arguments.worker]
    runner(model, few, arguments.rows) if arguments.worker != "figaroh" else runner(
        model, samples(model, 100, 8), "base"
    )
    arrays = samples(model, arguments.samples)
    before = peak()
    rank, predict = runner(model, arrays, arguments.rows)
    grown = peak() - before
    times = []
    for _ in range(arguments.runs):
        started = time.perf_counter()
        runner(model, arrays, arguments.rows)
        times.append(time.perf_counter() - started)
    return {
        "seconds": min(times),
        "median": float(np.median(times)),
        "megabytes": grown,
        "rank": rank,
        "prediction": predict(*other[:3])[:, :6].tolist(),
    }


def stream(arguments: argparse.Namespace) -> dict[str, Any]:
    """plantar from a generator: the same chunk of samples over and over, its torque with new noise."""
    from plantar.dynamics import fit_base_parameters_chunked

    model = talos(arguments.urdf)
    q, v, a, tau = samples(model, CHUNK)
    rng = np.random.default_rng(1)

    def chunks(count: int) -> Iterator[Arrays]:
        for _ in range(count // CHUNK):
            yield q, v, a, tau + rng.normal(0, NOISE, tau.shape)

    few = samples(model, 60, 8)
    fit_base_parameters_chunked(model, [few])
    before = peak()
    started = time.perf_counter()
    fit = fit_base_parameters_chunked(model, chunks(arguments.samples))
    seconds = time.perf_counter() - started
    return {"seconds": seconds, "megabytes": peak() - before, "rank": fit.rank, "samples": fit.samples}


def gemm_rate() -> float:
    """What this machine's matrix product reaches now [Gflop/s]."""
    a = np.random.default_rng(0).normal(size=(1500, 1500))
    times = []
    for _ in range(5):
        started = time.perf_counter()
        a @ a
        times.append(time.perf_counter() - started)
    return 2 * 1500**3 / min(times) / 1e9


def flops(model: pin.Model, count: int) -> float:
    """Least arithmetic of the base rows' fit: regressor, and products of all pairs of the columns of a row."""
    joints = model.njoints - 2
    torque, force = 10 + 7 * joints + 1, 4 + 2 * joints + 1
    return count * (45e3 + 3 * torque**2 + 3 * force**2)


def run(
    python: str, worker: str, arguments: argparse.Namespace, rows: str, count: int, runs: int
) -> dict[str, Any]:
    command = [
        python,
        __file__,
        "--worker",
        worker,
        "--rows",
        rows,
        "--samples",
        str(count),
        "--runs",
        str(runs),
    ]
    answer = subprocess.run([*command, "--urdf", str(TALOS)], capture_output=True, text=True)
    if answer.returncode != 0:
        raise SystemExit(f"{worker}: {answer.stderr.strip().splitlines()[-1]}")
    return dict(json.loads(answer.stdout.splitlines()[-1]))


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--samples", type=int, default=5000)
    parser.add_argument("--figaroh", default=None)
    parser.add_argument("--stream", type=int, default=1_000_000)
    parser.add_argument("--runs", type=int, default=7)
    parser.add_argument("--worker", default=None)
    parser.add_argument("--rows", default="base")
    parser.add_argument("--urdf", default=str(TALOS))
    arguments = parser.parse_args()
    if arguments.worker is not None:
        print(json.dumps(stream(arguments) if arguments.worker == "stream" else work(arguments)))
        return
    contenders = [
        ("base", "plantar", sys.executable),
        ("base", "scipy", sys.executable),
        ("base", "scipy-r", sys.executable),
    ]
    if arguments.figaroh:
        contenders.append(("base", "figaroh", arguments.figaroh))
    contenders += [("all", name, sys.executable) for name in ("plantar", "scipy", "scipy-r")]
    print(f"TALOS, {arguments.samples} samples; machine's matrix product {gemm_rate():.0f} Gflop/s")
    heads = f"{'rows':5} {'contender':10} {'best [ms]':>10} {'median':>8} {'MB':>7} {'rank':>5}"
    print(f"{heads} {'ratio':>7} {'agreement':>10}")
    mine: dict[str, dict[str, Any]] = {}
    for rows, name, python in contenders:
        runs = arguments.runs if name == "plantar" else 3
        found = run(python, name, arguments, rows, arguments.samples, runs)
        mine.setdefault(rows, found)
        ratio = found["seconds"] / mine[rows]["seconds"]
        here, there = (np.array(one["prediction"]) for one in (found, mine[rows]))
        agreement = f"{np.abs(here - there).max() / np.abs(there).max():.1e}" if here.size else "-"
        print(f"{rows:5} {name:10} {1e3 * found['seconds']:10.1f} {1e3 * found['median']:8.1f} "
              f"{found['megabytes']:7.0f} {found['rank']:5} {ratio:7.1f} {agreement:>10}", flush=True)  # fmt: skip
    rate, needed = gemm_rate(), flops(talos(str(TALOS)), arguments.samples)
    reached = needed / mine["base"]["seconds"] / 1e9
    print(f"base rows: {needed / 1e9:.2f} Gflop at least, {reached:.0f} Gflop/s: {100 * reached / rate:.0f} % of "
          f"the matrix product's {rate:.0f} Gflop/s")  # fmt: skip
    if arguments.stream:
        found = run(sys.executable, "stream", arguments, "base", arguments.stream, 1)
        print(
            f"{found['samples']} samples from a generator: {found['seconds']:.1f} s, {found['megabytes']:.0f} MB"
        )


if __name__ == "__main__":
    main()
