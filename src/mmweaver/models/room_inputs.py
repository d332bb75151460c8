"""Inputs of the network and of second-order paths: a photographed room, traced once for one radar."""

from dataclasses import dataclass

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import Scene
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.propagation.diffuse_clutter import diffuse_clutter, seed_of_room
from mmweaver.propagation.paths import Interaction, StaticPaths
from mmweaver.propagation.static_paths import ALL_PATHS, Propagation, RayTracedRoom
from mmweaver.propagation.things import ThingPaths, reflector_paths


@dataclass(frozen=True, kw_only=True)
class GivenRoom:
    """The network corrects the first-order paths in `view`; all other paths are those of physics."""

    view: SceneTensors
    traced: RayTracedRoom
    others: StaticPaths  # of second order, clutter, and reflectors
    things: ThingPaths

    @classmethod
    def of(
        cls, scene: Scene, config: RadarConfig, *, seed: int = 0, propagation: Propagation = ALL_PATHS
    ) -> "GivenRoom":
        """Traces a scene.

        Args:
            scene: The room.
            config: The radar.
            seed: Seed of phases and clutter.
            propagation: Which paths are traced.
        """
        traced = RayTracedRoom(scene, config, seed, propagation)
        others = [traced.paths.select(Interaction.ROOM_ROOM)]
        if propagation.clutter:
            others.append(diffuse_clutter(config, seed_of_room(scene) + seed, scene))
        if scene.reflectors:
            others.append(reflector_paths(scene.reflectors, scene.radar_pose, config))
        things = ThingPaths(scene, config)
        return cls(things=things, view=SceneTensors.of(scene, config, traced), traced=traced, others=StaticPaths.cat(others))
