"""Makes the bundled sample room: a furnished living room, rendered to rgb.webp, depth.png and camera.json.

Everything follows from the seed: `python tools/make_sample_room.py` remakes the bundled files.
"""

import argparse
import json
from pathlib import Path

import numpy as np
from PIL import Image
from sample_room.light import Renderer, smoothed
from sample_room.living_room import furnished_room

from mmweaver.core.pinhole import viewing_rays
from mmweaver.core.records import CameraIntrinsics
from mmweaver.core.seeding import stream

SAMPLE = Path(__file__).resolve().parents[1] / "src" / "mmweaver" / "sample"

WIDTH, HEIGHT = 640, 480
FIELD_OF_VIEW_DEG = 87.0  # across, as a RealSense D455's depth
CAMERA_HEIGHT_M = 1.2
PITCH_DEG = 9.0  # downwards
DEPTH_UNIT_M = 0.001
BASELINE_FOCAL_M_PX = 0.095 * 337.0  # of the stereo pair whose errors the depth shows
DISPARITY_STEP_PX, DISPARITY_NOISE_PX = 1 / 32, 0.04


def camera() -> CameraIntrinsics:
    focal = WIDTH / 2 / np.tan(np.deg2rad(FIELD_OF_VIEW_DEG / 2))
    return CameraIntrinsics(
        fx=float(round(focal, 2)), fy=float(round(focal, 2)), cx=(WIDTH - 1) / 2, cy=(HEIGHT - 1) / 2,
        width=WIDTH, height=HEIGHT,
    )  # fmt: skip


def room_from_camera() -> np.ndarray:
    sine, cosine = np.sin(np.deg2rad(PITCH_DEG)), np.cos(np.deg2rad(PITCH_DEG))
    return np.array([[1, 0, 0], [0, -sine, cosine], [0, -cosine, -sine]])


def render(seed: int, lamp_samples: int, bounce_samples: int, oversampling: int) -> tuple[np.ndarray, np.ndarray]:
    """The photo (height, width, 3) in 8 bits, and the exact depth along the optical axis in metres."""
    origin = np.array([0.0, 0.0, CAMERA_HEIGHT_M])
    renderer = Renderer(furnished_room(seed), seed, lamp_samples, bounce_samples)
    pixels = viewing_rays(camera()).reshape(-1, 3)
    colour, light, glow = (np.zeros((HEIGHT * WIDTH, 3)) for _ in range(3))
    for turn in range(oversampling**2):
        shift = np.array([turn % oversampling, turn // oversampling]) / oversampling + (0.5 / oversampling - 0.5)
        rays = (pixels + np.append(shift / camera().fx, 0)) @ room_from_camera().T
        parts = renderer.picture(origin, rays / np.linalg.norm(rays, axis=1)[:, None])
        for total, part in zip((colour, light, glow), parts, strict=True):
            total += part / oversampling**2
    rays = pixels @ room_from_camera().T
    length = np.linalg.norm(rays, axis=1)
    distance, _, points, normals = renderer.hit(np.tile(origin, (len(rays), 1)), rays / length[:, None])
    smooth = smoothed(*(part.reshape(HEIGHT, WIDTH, 3) for part in (light, points, normals)))
    photo = developed((colour * smooth.reshape(-1, 3) + glow).reshape(HEIGHT, WIDTH, 3))
    return np.clip(np.round(255 * photo), 0, 255).astype(np.uint8), (distance / length).reshape(HEIGHT, WIDTH)


def developed(radiance: np.ndarray) -> np.ndarray:
    """Exposure, a soft shoulder for the highlights, and the sRGB curve."""
    value = 1.8 * radiance
    value = value * (1 + value / 9.0) / (1 + value * 0.75)
    value = np.clip(value, 0, 1)
    return np.where(value < 0.0031308, 12.92 * value, 1.055 * value ** (1 / 2.4) - 0.055)


def measured_depth(depth_m: np.ndarray, seed: int) -> np.ndarray:
    """What a stereo camera would say: errors and steps in disparity, and holes beside near edges and on the window."""
    generator = stream(seed, "depth")
    disparity = BASELINE_FOCAL_M_PX / depth_m
    coarse = generator.normal(0, DISPARITY_NOISE_PX, (HEIGHT // 4, WIDTH // 4))
    disparity = (
        disparity + np.kron(coarse, np.ones((4, 4))) + generator.normal(0, DISPARITY_NOISE_PX / 3, depth_m.shape)
    )
    disparity = np.round(disparity / DISPARITY_STEP_PX) * DISPARITY_STEP_PX
    measured = BASELINE_FOCAL_M_PX / disparity
    # The second eye, at the left, does not see what lies just left of a near thing.
    shadow = np.zeros(depth_m.shape, bool)
    jump = np.maximum(disparity[:, 1:] - disparity[:, :-1], 0)
    for column in range(1, 13):
        shadow[:, : -column - 1] |= (jump[:, column:] > max(column, 1.5)) & (jump[:, column:] < 60)
    speckle = np.kron(generator.random((HEIGHT // 4, WIDTH // 4)) < 0.0015, np.ones((4, 4))) > 0
    counts = np.round(measured / DEPTH_UNIT_M)
    return np.where(shadow | speckle, 0, counts).astype(np.uint16)


def write_sample(folder: Path, seed: int, lamp_samples: int, bounce_samples: int, oversampling: int) -> None:
    photo, depth_m = render(seed, lamp_samples, bounce_samples, oversampling)
    folder.mkdir(parents=True, exist_ok=True)
    Image.fromarray(photo).save(folder / "rgb.webp", lossless=True, quality=100, method=6)
    Image.fromarray(measured_depth(depth_m, seed)).save(folder / "depth.png", optimize=True)
    content = {**vars(camera()), "depth_unit_m": DEPTH_UNIT_M}
    (folder / "camera.json").write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=SAMPLE)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--lamp-samples", type=int, default=4)
    parser.add_argument("--bounce-samples", type=int, default=4)
    parser.add_argument("--oversampling", type=int, default=3)
    arguments = parser.parse_args()
    write_sample(
        arguments.out, arguments.seed, arguments.lamp_samples, arguments.bounce_samples, arguments.oversampling
    )
    print(f"wrote {arguments.out}")


if __name__ == "__main__":
    main()
