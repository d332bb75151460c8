"""A room and its people in the frame of a radar that does not stand at the camera."""

from dataclasses import replace

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.radar_pose import RadarPose
from mmweaver.core.records import FreeSpace, PoseSequence, Scene
from mmweaver.core.skeleton import joint

WIDEST_RAD = np.radians(60.0)  # from the boresight, in azimuth


def scene_seen_from(scene: Scene, pose: RadarPose) -> Scene:
    """Transforms a scene into the frame of a radar at another pose; the photo remains the camera's.

    Floor plan, seats and landmarks, which plan motions in the camera's frame, are dropped. `floor_z_m` becomes the
    floor's height straight below the radar.

    Args:
        scene: The room in the frame of a radar at the camera.
        pose: Pose of the radar relative to the camera.

    Returns:
        The scene in the radar's frame; `scene` itself if the radar is at the camera.

    Raises:
        InputError: If the radar would be below the floor.
    """
    if pose.is_at_camera:
        return scene
    if pose.z_m <= scene.floor_z_m:
        raise InputError(
            f"a radar {-pose.z_m:g} m below the camera would be under the floor, which is {-scene.floor_z_m:.2f} m"
            " below it"
        )
    nothing = np.zeros(0)
    no_cells = np.zeros((0, 0), bool)
    return replace(
        scene,
        radar_pose=pose,
        radar_from_camera=pose.from_level @ scene.radar_from_camera,
        vertices_m=pose.seen(scene.vertices_m).astype(scene.vertices_m.dtype),
        planes=tuple(plane.moved(pose.seen, pose.seen_directions) for plane in scene.planes),
        floor_z_m=scene.floor_z_m - pose.z_m,
        free_space=FreeSpace(x_m=nothing, y_m=nothing, is_free=no_cells, is_seen=no_cells),
        seats=(),
        landmarks=(),
    )


def people_seen_from(people: tuple[PoseSequence, ...], pose: RadarPose) -> tuple[PoseSequence, ...]:
    """Transforms motions into the frame of a radar at another pose.

    Args:
        people: Motions with joints in metres in the frame of a radar at the camera.
        pose: Pose of the radar relative to the camera.

    Returns:
        The motions with joints in the radar's frame.
    """
    if pose.is_at_camera:
        return people
    return tuple(replace(one, joints_m=pose.seen(one.joints_m)) for one in people)


def unseen_notes(people: tuple[PoseSequence, ...], range_window_m: tuple[float, float]) -> tuple[str, ...]:
    """Reports each person who leaves the radar's range window or its beam of +-60 degrees.

    Args:
        people: Motions in the radar's frame; the pelvis counts.
        range_window_m: Nearest and farthest range in metres.

    Returns:
        A sentence per person who is outside in some frames.
    """
    notes = []
    for number, person in enumerate(people, 1):
        pelvis_m = person.joints_m[:, joint("pelvis")]
        distance_m = np.linalg.norm(pelvis_m, axis=1)
        seen = (distance_m > range_window_m[0]) & (distance_m < range_window_m[1])
        seen &= np.abs(np.arctan2(pelvis_m[:, 0], pelvis_m[:, 1])) < WIDEST_RAD
        if not seen.all():
            who = "the person" if len(people) == 1 else f"person {number}"
            notes.append(
                f"{who} is within the radar's range and 60 degrees of its boresight in {seen.sum()} of"
                f" {len(seen)} frames"
            )
    return tuple(notes)
