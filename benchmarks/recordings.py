"""Memory and time of long inputs: a .bin of 2.15 GB through `mmweaver process`, a cloud of 100,000 frames, a photo of
8k. Each runs in a process of its own. Writes results/benchmark/recordings.json and prints the same as a table.
"""

import os
import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from measuring import report, results_folder
from PIL import Image

from mmweaver.core.boards import AWR1843
from mmweaver.core.records import AdcCube
from mmweaver.io.dca1000 import write_bin

BIN_BYTES, CLOUD_FRAMES, POINTS_A_FRAME = 2.15e9, 100_000, 15
PHOTO = (7680, 4320)
RADAR = replace(AWR1843, num_loops=16)


def spent(*words: str) -> dict[str, float]:
    """Largest memory and CPU-seconds of a command."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return {"cpu_s": cpu_s, "wall_s": time.perf_counter() - start, "largest_gb": after.ru_maxrss / 1e6}


def write_recording(folder: Path) -> tuple[Path, Path]:
    """Ten frames of an echo and noise, again and again; and the radar."""
    random = np.random.default_rng(0)
    shape = (10, RADAR.num_loops, RADAR.num_tx, RADAR.num_rx, RADAR.num_samples)
    tone = 300 * np.exp(2j * np.pi * 40 * np.arange(RADAR.num_samples) / RADAR.num_samples)
    samples = tone + 20 * (random.standard_normal(shape) + 1j * random.standard_normal(shape))
    write_bin(folder / "ten.bin", AdcCube(samples=samples.astype(np.complex64), config=RADAR, scale=1.0))
    ten = (folder / "ten.bin").read_bytes()
    with (folder / "long.bin").open("wb") as file:
        for _ in range(int(BIN_BYTES / len(ten))):
            file.write(ten)
    (folder / "radar.json").write_text(RADAR.to_json())
    return folder / "long.bin", folder / "radar.json"


def write_cloud(path: Path) -> None:
    """A CSV log of some points in each of many frames."""
    random = np.random.default_rng(1)
    with path.open("w") as file:
        file.write("Frame #,# Obj,X,Y,Z,Doppler,Intensity\n")
        for frame in range(CLOUD_FRAMES):
            for x, y, z, v in random.normal((0, 3, 0, 0), 1, (POINTS_A_FRAME, 4)):
                file.write(f"{frame},{POINTS_A_FRAME},{x:.3f},{abs(y):.3f},{z:.3f},{v:.3f},20\n")


def main() -> int:
    """Measures and writes."""
    out, values = results_folder(__doc__), {}
    weaver = (sys.executable, "-m", "mmweaver")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_cloud(folder / "cloud.csv")
        found = spent(*weaver, "points", str(folder / "cloud.csv"), "-o", str(folder / "points.npz"))
        values |= {f"cloud_{key}": value for key, value in found.items()}
        depth = np.full((PHOTO[1] // 8, PHOTO[0] // 8), 2500, np.uint16)
        Image.fromarray(np.zeros((PHOTO[1], PHOTO[0], 3), np.uint8)).save(folder / "rgb.jpg")
        Image.fromarray(depth).save(folder / "depth.png")
        code = "import sys; from mmweaver.scene.read_photo import read_photo; read_photo(sys.argv[1], sys.argv[2])"
        found = spent(sys.executable, "-c", code, str(folder / "rgb.jpg"), str(folder / "depth.png"))
        values |= {f"photo_{key}": value for key, value in found.items()}
        recording, radar = write_recording(folder)
        found = spent(*weaver, "process", str(recording), "--radar", str(radar), "--out", str(folder / "out"))
        values |= {f"process_{key}": value for key, value in found.items()}
    config = {"bin_bytes": BIN_BYTES, "cloud_frames": CLOUD_FRAMES, "points_per_frame": POINTS_A_FRAME, "photo": PHOTO}
    report(out, "recordings", {"name": "made files", "source": "benchmarks/recordings.py"}, values, config)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
