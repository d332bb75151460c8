"""The check itself: a person in place scores, the same signal against another person does not."""

from dataclasses import replace

from mmweaver.weaver.front_door import Weaver
from studies.scene.real_rooms import agreement


def test_a_person_elsewhere_is_told_from_one_in_place():
    weaver = Weaver("physics")
    room = weaver.sample_room()
    result = weaver.generate(room, "someone does jumping jacks", seed=0)
    track = agreement(result)
    assert track.moving >= 10
    assert track.right / track.moving >= 0.9
    assert track.by_chance / track.moving < 0.6
    shift = [0.0, 1.5, 0.0]
    moved = replace(
        result,
        poses=(replace(result.pose, joints_m=result.pose.joints_m + shift),),
        motions=(replace(result.motion, joints_m=result.motion.joints_m + shift),),
    )
    elsewhere = agreement(moved)
    assert elsewhere.right / max(elsewhere.moving, 1) < 0.3
