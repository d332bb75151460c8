"""The kinds of rooms: size, surfaces, and furniture; groups are placed in the order given."""

from dataclasses import dataclass

from mmweaver.core.registry import Registry
from mmweaver.scene.procedural import groups, objects, seat_furniture, storage_furniture
from mmweaver.scene.procedural.groups import Maker, freestanding, on_wall_group, shelves, single


@dataclass(frozen=True, kw_only=True)
class RoomKind:
    """A recipe for rooms. All `required` groups are placed; each `optional` one with its probability."""

    name: str
    width_m: tuple[float, float]
    wall_distance_m: tuple[float, float]  # from the radar to the wall that it faces
    walls: tuple[str, ...]
    floors: tuple[str, ...]
    required: tuple[Maker, ...]
    optional: tuple[tuple[float, Maker], ...]
    num_windows: int = 1


_SMALL_OBJECTS = (
    (0.5, single(objects.bin_)),
    (0.5, single(objects.plant)),
    (0.6, on_wall_group(objects.picture)),
    (0.5, on_wall_group(objects.picture)),
)
_USUAL_DISTANCE_M = (2.9, 3.35)

_ROOM_KINDS = (
    RoomKind(
        name="office",
        width_m=(3.2, 4.6),
        wall_distance_m=_USUAL_DISTANCE_M,
        walls=("paint", "concrete"),
        floors=("carpet", "linoleum", "boards"),
        required=(groups.desk_place, shelves(1)),
        optional=(
            (0.7, groups.desk_place),
            (0.6, single(storage_furniture.pedestal)),
            (0.4, groups.board),
            *_SMALL_OBJECTS,
        ),
    ),
    RoomKind(
        name="living_room",
        width_m=(3.6, 4.8),
        wall_distance_m=_USUAL_DISTANCE_M,
        walls=("paint", "brick", "panels"),
        floors=("boards", "carpet"),
        required=(groups.sofa_place,),
        optional=(
            (0.8, groups.television_place),
            (0.6, groups.armchair_place),
            (0.5, shelves(1)),
            (0.4, freestanding(objects.rug)),
            *_SMALL_OBJECTS,
        ),
    ),
    RoomKind(
        name="lab",
        width_m=(3.6, 5.0),
        wall_distance_m=_USUAL_DISTANCE_M,
        walls=("paint", "concrete", "tiles"),
        floors=("linoleum", "tiles"),
        required=(groups.bench_place,),
        optional=(
            (0.8, groups.bench_place),
            (0.6, groups.desk_place),
            (0.6, single(storage_furniture.locker)),
            (0.4, groups.board),
            (0.5, single(storage_furniture.steel_rack)),
            (0.5, single(objects.bin_)),
        ),
    ),
    RoomKind(
        name="kitchen",
        width_m=(3.2, 4.2),
        wall_distance_m=_USUAL_DISTANCE_M,
        walls=("paint", "tiles"),
        floors=("tiles", "boards"),
        required=(groups.kitchen_row,),
        optional=((0.7, groups.small_dining), (0.4, groups.kitchen_counter), *_SMALL_OBJECTS),
    ),
    RoomKind(
        name="library",
        width_m=(3.6, 5.0),
        wall_distance_m=_USUAL_DISTANCE_M,
        walls=("paint", "panels"),
        floors=("boards", "carpet"),
        required=(shelves(3), shelves(2)),
        optional=(
            (0.7, shelves(2)),
            (0.7, groups.laptop_desk),
            (0.6, groups.armchair_place),
            (0.4, single(objects.floor_lamp)),
            *_SMALL_OBJECTS,
        ),
    ),
    RoomKind(
        name="bedroom",
        width_m=(3.4, 4.4),
        wall_distance_m=_USUAL_DISTANCE_M,
        walls=("paint", "panels"),
        floors=("boards", "carpet"),
        required=(groups.bed_place,),
        optional=(
            (0.7, single(storage_furniture.wardrobe)),
            (0.6, single(storage_furniture.dresser)),
            (0.4, groups.laptop_desk),
            (0.3, groups.armchair_place),
            *_SMALL_OBJECTS,
        ),
    ),
    RoomKind(
        name="dining_room",
        width_m=(3.6, 4.8),
        wall_distance_m=_USUAL_DISTANCE_M,
        walls=("paint", "panels", "brick"),
        floors=("boards", "tiles", "carpet"),
        required=(groups.dining_place,),
        optional=(
            (0.7, single(storage_furniture.dresser)),
            (0.5, shelves(1)),
            (0.4, single(objects.floor_lamp)),
            *_SMALL_OBJECTS,
        ),
    ),
    RoomKind(
        name="meeting_room",
        width_m=(3.6, 5.0),
        wall_distance_m=(3.0, 3.45),
        walls=("paint", "concrete", "panels"),
        floors=("carpet", "boards"),
        required=(groups.meeting_place, groups.television_on_wall),
        optional=((0.6, groups.board), (0.5, single(storage_furniture.cabinet)), *_SMALL_OBJECTS),
    ),
    RoomKind(
        name="classroom",
        width_m=(4.2, 5.4),
        wall_distance_m=(3.2, 3.45),
        walls=("paint", "concrete"),
        floors=("linoleum", "boards"),
        required=(groups.teacher, groups.pupils),
        optional=(
            (0.5, groups.pupils),
            (0.6, single(storage_furniture.cabinet)),
            (0.5, shelves(1)),
            *_SMALL_OBJECTS,
        ),
        num_windows=2,
    ),
    RoomKind(
        name="corridor",
        width_m=(1.7, 2.4),
        wall_distance_m=(3.2, 5.2),
        walls=("paint", "brick", "concrete"),
        floors=("linoleum", "tiles", "boards"),
        required=(single(seat_furniture.bench),),
        optional=(
            (0.5, single(storage_furniture.locker)),
            (0.4, single(storage_furniture.cabinet)),
            (0.6, single(objects.plant)),
            (0.7, on_wall_group(objects.picture)),
            (0.6, on_wall_group(objects.picture)),
            (0.4, single(objects.bin_)),
        ),
        num_windows=0,
    ),
    RoomKind(
        name="gym",
        width_m=(3.8, 5.2),
        wall_distance_m=_USUAL_DISTANCE_M,
        walls=("paint", "brick", "concrete"),
        floors=("linoleum", "boards"),
        required=(groups.treadmill_place, single(storage_furniture.dumbbell_rack)),
        optional=(
            (0.7, freestanding(seat_furniture.weight_bench)),
            (0.5, on_wall_group(objects.mirror)),
            (0.6, freestanding(objects.mat)),
            (0.4, single(seat_furniture.bench)),
            (0.3, groups.television_on_wall),
        ),
    ),
    RoomKind(
        name="workshop",
        width_m=(3.6, 4.8),
        wall_distance_m=_USUAL_DISTANCE_M,
        walls=("concrete", "brick", "paint"),
        floors=("concrete",),
        required=(groups.workbench_place, single(storage_furniture.steel_rack)),
        optional=(
            (0.6, groups.workbench_place),
            (0.6, single(objects.carton)),
            (0.5, single(objects.carton)),
            (0.5, single(storage_furniture.locker)),
            (0.4, freestanding(seat_furniture.stool)),
        ),
    ),
)

KINDS: Registry[RoomKind] = Registry("kind of room", [(kind.name, kind) for kind in _ROOM_KINDS])
