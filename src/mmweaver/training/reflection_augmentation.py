"""Left-right reflection as augmentation; mean power maps of a radar are symmetric under it."""

from dataclasses import replace

import torch
from torch import Tensor

from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.paths.mean_power import PowerMaps
from mmweaver.training.network_loss import Targets

_OTHER_SIDE = {"left": "right", "right": "left"}
_POINT_X = (1, 5)  # columns of a point's features: position and direction
_PLANE_X = (6,)  # columns of a plane's features: normal


def reflected_scene(scene: SceneTensors) -> SceneTensors:
    """The scene reflected at the plane x = 0."""
    flip = scene.point_m.new_tensor([-1.0, 1.0, 1.0])
    camera = scene.camera.clone()
    camera[..., 2] = scene.image.shape[-1] - 1 - camera[..., 2]
    return replace(
        scene,
        image=scene.image.flip(-1),
        depth_m=scene.depth_m.flip(-1),
        point_m=scene.point_m * flip,
        point_features=_negated(scene.point_features, _POINT_X),
        camera_from_radar=scene.camera_from_radar * flip * flip[:, None],
        camera_m=scene.camera_m * flip,
        camera=camera,
        plane_centre_m=scene.plane_centre_m * flip,
        plane_axes=scene.plane_axes * flip,
        plane_features=_negated(scene.plane_features, _PLANE_X),
    )


def reflected_joints(joints: Tensor) -> Tensor:
    """Positions or velocities (..., 22, 3) of the reflected person, with left and right joints exchanged."""
    order = [JOINT_NAMES.index(_other(name)) for name in JOINT_NAMES]
    return joints[..., order, :] * joints.new_tensor([-1.0, 1.0, 1.0])


def reflected_targets(targets: Targets) -> Targets:
    """Targets with azimuth reversed; range, Doppler and elevation are unchanged."""
    person = None if targets.person is None else _azimuth_flipped(targets.person)
    return Targets(maps=_azimuth_flipped(targets.maps), static=_azimuth_flipped(targets.static), person=person)


def _azimuth_flipped(maps: PowerMaps) -> PowerMaps:
    return replace(maps, range_azimuth=maps.range_azimuth.flip(-1))


def _negated(features: Tensor, columns: tuple[int, ...]) -> Tensor:
    sign = torch.ones(features.shape[-1], device=features.device)
    sign[list(columns)] = -1
    return features * sign


def _other(name: str) -> str:
    side, _, part = name.partition("_")
    return f"{_OTHER_SIDE[side]}_{part}" if side in _OTHER_SIDE else name
