"""RF-Genesis' tracer and signal path for our joints, rooms, radar and cube, as released and repaired.

Written from what its public repository does (Chen and Zhang, SenSys 2023; MIT), not from its code: a picture of the
body by Mitsuba (128 x 128 pixels, 30 a second) with distance and brightness of each pixel; pixels linearly interpolated
to every chirp; one echo a pixel. Its SMPL body, motion diffusion and environment pictures need weights of others: our
joints with a body of smooth capsules and one fixed smooth environment picture take their places.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import drjit as dr
import mitsuba as mi
import numpy as np

from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, PoseSequence, RadarCube
from mmweaver.core.seeding import stream
from mmweaver.propagation.body_model import ScatteringBody
from mmweaver.signal.cube import radar_cube
from studies.peers.capsule_mesh import BodyMesh, capsule_mesh

mi.set_variant("llvm_ad_rgb")
dr.set_thread_count(1)

MOTION_RATE_HZ = 30
FAINTEST = 0.1  # distance and brightness below which it drops a pixel
ENVIRONMENT_PIXELS, ENVIRONMENT_FIELD_DEG = 64, 60.0
SAME_SURFACE_M = 0.1
OLDEST_LLVM = 17  # 15 cannot compile a maximum of two floats
Triangles = tuple[np.ndarray, np.ndarray]  # vertices (vertex, 3) in metres, faces (face, 3)


@dataclass(frozen=True, kw_only=True)
class RfGenesis:
    """What is traced and how; the default is as released.

    Released: the picture is taken 3 m behind the radar and 1 m above it; distance is taken for brightness; chirps are
    spread over the whole frame and all transmitters send at once; pixels that miss the body are filled in place from
    the next picture, so that the body leaves a trail. `repaired`: the picture is taken at the radar, a pixel weighs as
    a rough surface of its area, transmitters take their turns within the active time, and only pixels that meet the
    same surface in two pictures are interpolated.
    """

    repaired: bool = False
    has_environment: bool = True  # its own, always at 5 to 10 m, independent of the body
    room: Triangles | None = None  # traced along with the body
    pixels: int = 128

    def cube(self, pose: PoseSequence, config: RadarConfig, num_frames: int) -> RadarCube:
        """The cube of a person, without noise and of unknown scale."""
        return radar_cube(self.adc(pose, config, num_frames))

    def adc(self, pose: PoseSequence, config: RadarConfig, num_frames: int) -> AdcCube:
        """The samples of a person, without noise and of unknown scale."""
        _check_llvm()
        spread_s = config.loop_period_s if self.repaired else config.frame_period_s / config.num_loops
        frame_s = np.arange(num_frames)[:, None] * config.frame_period_s
        time_s = frame_s + np.arange(config.num_loops) * spread_s  # (frame, loop) of the first chirp
        pictures = self._pictures(pose, time_s)
        chirps = _Chirps(config)
        echoes = (
            _RepairedEchoes(pictures, chirps, self.pixels)
            if self.repaired
            else _ReleasedEchoes(pictures, chirps, self.has_environment)
        )
        shape = (num_frames, config.num_loops, config.num_tx, config.num_rx, config.num_samples)
        samples = np.empty(shape, np.complex64)
        for index in np.ndindex(*time_s.shape):
            samples[index] = echoes.samples(float(time_s[index]))
        return AdcCube(samples=samples, config=config, scale=1.0)

    def _pictures(self, pose: PoseSequence, wanted_s: np.ndarray) -> "Pictures":
        """The pictures that the wanted times lie between, by number."""
        first = np.unique((wanted_s * MOTION_RATE_HZ).astype(int))
        numbers = np.union1d(first, first + 1)
        time_s = np.clip(numbers / MOTION_RATE_HZ, pose.time_s[0], pose.time_s[-1])
        flat = pose.joints_m.reshape(len(pose.time_s), -1)
        joints_m = np.stack([np.interp(time_s, pose.time_s, one) for one in flat.T], -1).reshape(len(time_s), 22, 3)
        mesh = capsule_mesh(ScatteringBody(0, pose.height_m), joints_m)
        return dict(zip(map(int, numbers), _Camera(self, mesh).pictures(mesh), strict=True))


@dataclass
class BodyPicture:
    """One motion frame's picture, a row each pixel; distance and brightness are 0 where a ray meets nothing."""

    distance_m: np.ndarray
    brightness: np.ndarray  # needed as released alone, and empty otherwise
    place_m: np.ndarray  # (pixel, 3)
    cos: np.ndarray  # of the angle between ray and surface

    def fill_from(self, other: "BodyPicture") -> None:
        """Gives dark pixels what another picture has there, in place."""
        dark = self.brightness == 0
        for own, given in zip(self._columns, other._columns, strict=True):
            own[dark] = given[dark]

    @property
    def _columns(self) -> tuple[np.ndarray, ...]:
        return self.distance_m, self.brightness, self.place_m


Pictures = dict[int, BodyPicture]


def _check_llvm() -> None:
    """Raises InputError for a compiler that ends the whole process at Mitsuba's code."""
    found = dr.detail.llvm_version()
    if found[0] < OLDEST_LLVM:
        raise InputError(
            f"RF-Genesis' tracer needs LLVM {OLDEST_LLVM} or newer, not {'.'.join(map(str, found))}; install one"
            " (apt-get install libllvm19) and name its libLLVM in the environment as DRJIT_LIBLLVM_PATH"
        )


class _Camera:
    """Mitsuba's camera and light; x right, y up, -z away from the radar."""

    def __init__(self, settings: RfGenesis, mesh: BodyMesh):
        transform, pixels = mi.ScalarTransform4f, settings.pixels
        eye, light = ([0, 0, 0], [0, 0, 0]) if settings.repaired else ([0, 1, 3], [0, 0, 3])
        to_world = transform().look_at(origin=eye, target=[eye[0], eye[1], eye[2] - 3], up=[0, 1, 0])
        film = {
            "type": "hdrfilm", "width": pixels, "height": pixels, "rfilter": {"type": "gaussian"},
            "pixel_format": "luminance", "component_format": "float32",
        }  # fmt: skip
        spot = {
            "type": "spot", "cutoff_angle": 40, "intensity": 1000.0,
            "to_world": transform().look_at(origin=light, target=[light[0], light[1], light[2] - 3], up=[0, 1, 0]),
        }  # fmt: skip
        point = {"type": "point", "position": light, "intensity": 1000.0}
        scene = {
            "type": "scene", "integrator": {"type": "direct"}, "light": point if settings.repaired else spot,
            "camera": {
                "type": "perspective", "to_world": to_world, "fov": 80 if settings.repaired else 60, "film": film,
                "sampler": {"type": "independent", "sample_count": 1, "seed": 42},
            },
            "body": _mesh(mesh.vertices_m[0], mesh.faces),
        }  # fmt: skip
        if settings.room is not None:
            scene["room"] = _mesh(*settings.room)
        self._scene, self._pixels, self._has_light = mi.load_dict(scene), pixels, not settings.repaired
        self._parameters = mi.traverse(self._scene)
        self._vertices = next(
            key for key, _ in self._parameters.items() if key.startswith("body") and "positions" in key
        )

    def pictures(self, mesh: BodyMesh) -> Iterator[BodyPicture]:
        sensor = self._scene.sensors()[0]
        index = np.arange(self._pixels**2)
        across, down = index % self._pixels / self._pixels, index // self._pixels / self._pixels
        film_place = mi.Point2f(mi.Float(across.astype(np.float32)), mi.Float(down.astype(np.float32)))
        rays, _ = sensor.sample_ray(0, 0.5, film_place, mi.Point2f(0.5, 0.5))
        for vertices_m in mesh.vertices_m:
            self._parameters[self._vertices] = dr.ravel(mi.Point3f(_to_mitsuba(vertices_m).T))
            self._parameters.update()
            met = self._scene.ray_intersect(rays)
            distance_m = np.array(met.t, float)
            is_met = np.isfinite(distance_m) & (distance_m < 9999)
            place = np.where(is_met[:, None], np.array(met.p, float).T, 0.0)
            yield BodyPicture(
                distance_m=np.where(is_met, distance_m, 0.0),
                brightness=self._brightness(),
                place_m=np.stack([place[:, 0], -place[:, 2], place[:, 1]], -1),
                cos=np.abs((np.array(met.n).T * np.array(rays.d).T).sum(-1)),
            )

    def _brightness(self) -> np.ndarray:
        if not self._has_light:
            return np.empty(0)
        return np.array(mi.render(self._scene, spp=32), float)[:, :, 0].ravel()


def _mesh(vertices_m: np.ndarray, faces: np.ndarray) -> "mi.Mesh":
    properties = mi.Properties()
    properties["bsdf"] = mi.load_dict({"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.8, 0.8, 0.8]}})
    mesh = mi.Mesh("mesh", len(vertices_m), len(faces), props=properties)
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = dr.ravel(mi.Point3f(_to_mitsuba(vertices_m).T))
    parameters["faces"] = dr.ravel(mi.Vector3u(np.asarray(faces, np.uint32).T))
    parameters.update()
    return mesh


def _to_mitsuba(points_m: np.ndarray) -> np.ndarray:
    return np.stack([points_m[..., 0], points_m[..., 2], -points_m[..., 1]], -1).astype(np.float32)


def _environment() -> tuple[np.ndarray, np.ndarray]:
    """Places (pixel, 3) and amplitudes of one smooth picture, read as RF-Genesis reads those of its diffusion model."""
    size = ENVIRONMENT_PIXELS
    steps = np.cumsum(np.cumsum(stream(0, "environment picture").standard_normal((size, size)), 0), 1)
    picture = np.clip(0.5 + 0.2 * steps / size, 0.0, 1.0)
    focal = size / (2 * np.tan(np.radians(ENVIRONMENT_FIELD_DEG) / 2))
    down, across = (np.mgrid[:size, :size] - size / 2) / focal
    distance_m = 5 * picture + 5
    return np.stack([across, np.ones_like(across), -down], -1).reshape(-1, 3) * distance_m.reshape(
        -1, 1
    ), picture.ravel()


def _pair(pictures: Pictures, time_s: float) -> tuple[BodyPicture, BodyPicture, float]:
    """The pictures before and after a time, and how far it lies between them."""
    place = time_s * MOTION_RATE_HZ
    return pictures[int(place)], pictures[int(place) + 1], place - int(place)


class _ReleasedEchoes:
    """All transmitters at once; a pixel's distance is its amplitude."""

    def __init__(self, pictures: Pictures, chirps: "_Chirps", has_environment: bool):
        self._pictures, self._chirps = pictures, chirps
        self._environment = chirps.samples(*_environment()) if has_environment else 0.0  # never moves

    def samples(self, time_s: float) -> np.ndarray:
        """(tx, rx, sample) of one chirp."""
        before, after, share = _pair(self._pictures, time_s)
        before.fill_from(after)
        after.fill_from(before)
        distance_m = before.distance_m + share * (after.distance_m - before.distance_m)
        brightness = before.brightness + share * (after.brightness - before.brightness)
        kept = (distance_m > FAINTEST) & (brightness > FAINTEST)
        places_m = (before.place_m + share * (after.place_m - before.place_m))[kept]
        return self._chirps.samples(places_m, distance_m[kept]) + self._environment


class _RepairedEchoes:
    """Transmitters in turn; a pixel is a rough surface, interpolated where both pictures meet the same one."""

    def __init__(self, pictures: Pictures, chirps: "_Chirps", pixels: int):
        self._pictures, self._chirps = pictures, chirps
        self._rough = np.exp(2j * np.pi * stream(1, "pixels").random(pixels**2))
        self._before: BodyPicture | None = None

    def samples(self, time_s: float) -> np.ndarray:
        """(tx, rx, sample) of the chirps of one loop."""
        before, after, share = _pair(self._pictures, time_s)
        if before is not self._before:
            self._meet(before, after)
        config = self._chirps.config
        turn = config.loop_period_s / len(config.tx_order) * MOTION_RATE_HZ
        places_m = np.empty((config.num_tx, len(self._begin_m), 3))
        for number, transmitter in enumerate(config.tx_order):
            places_m[transmitter] = self._begin_m + (share + number * turn) * self._step_m
        return self._chirps.samples(places_m, self._amplitude) + self._still

    def _meet(self, before: BodyPicture, after: BodyPicture) -> None:
        """Sorts pixels into those that move from one picture to the next and those that do not."""
        kept = (before.distance_m > FAINTEST) & (after.distance_m > FAINTEST)
        kept &= np.abs(before.distance_m - after.distance_m) < SAME_SURFACE_M
        # a pixel's area is distance^2 / cos, what it scatters back falls as cos^2, the path loss divides by distance^2
        amplitude = np.sqrt(np.maximum(before.cos, 1e-3)) * before.distance_m * self._rough
        moves = kept & (after.place_m != before.place_m).any(axis=1)
        still = kept & ~moves
        self._begin_m, self._step_m = before.place_m[moves], (after.place_m - before.place_m)[moves]
        self._amplitude, self._before = amplitude[moves], before
        self._still = self._chirps.samples(before.place_m[still], amplitude[still])


class _Chirps:
    """Samples of one loop: beat phases of every point, at the radar's sample times."""

    def __init__(self, config: RadarConfig):
        self.config = config
        self.tx_m, self.rx_m = np.asarray(config.tx_position_m), np.asarray(config.rx_position_m)

    def samples(self, places_m: np.ndarray, amplitude: np.ndarray) -> np.ndarray:
        """(tx, rx, sample) of points (point, 3), or (tx, point, 3) where they move, with amplitudes (point,)."""
        config = self.config
        places_m = np.broadcast_to(places_m, (config.num_tx, *places_m.shape[-2:]))
        weight = np.concatenate(
            [self._weights(place, amplitude, tx) for tx, place in zip(self.tx_m, places_m, strict=True)]
        )
        delay_s = 2 * np.linalg.norm(places_m[0], axis=1) / SPEED_OF_LIGHT_MPS
        return (weight @ self._beat(delay_s)).reshape(len(self.tx_m), len(self.rx_m), config.num_samples)

    def _weights(self, place_m: np.ndarray, amplitude: np.ndarray, tx_m: np.ndarray) -> np.ndarray:
        """(rx, point): free-space loss as RF-Genesis has it, a power ratio used as an amplitude, and carrier phase."""
        config = self.config
        length_m = np.linalg.norm(place_m - tx_m, axis=1) + np.linalg.norm(place_m - self.rx_m[:, None], axis=2)
        delay_s = length_m / SPEED_OF_LIGHT_MPS
        loss = (config.wavelength_m / (4 * np.pi * length_m)) ** 2
        cycles = config.start_frequency_hz * delay_s - config.chirp_slope_hz_per_s * delay_s**2 / 2
        return (amplitude * loss * np.exp(2j * np.pi * cycles)).astype(np.complex64)

    def _beat(self, delay_s: np.ndarray) -> np.ndarray:
        """(point, sample) exp(j 2 pi slope delay t), by doubling."""
        config = self.config
        step = np.exp(2j * np.pi * config.chirp_slope_hz_per_s * delay_s / config.sample_rate_hz)
        beat = np.empty((len(delay_s), config.num_samples), np.complex64)
        beat[:, 0] = np.exp(2j * np.pi * config.chirp_slope_hz_per_s * delay_s * config.adc_start_time_s)
        done = 1
        while done < config.num_samples:
            more = min(done, config.num_samples - done)
            beat[:, done : done + more] = beat[:, :more] * (step**done).astype(np.complex64)[:, None]
            done += more
        return beat
