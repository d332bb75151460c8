"""The kinds of rooms: how large, of what, and which furniture; groups are tried in the order given."""

from dataclasses import dataclass

from mmweaver.core.registry import Registry
from mmweaver.scene.procedural import groups, objects, seat_furniture, storage_furniture
from mmweaver.scene.procedural.groups import Maker, hung, shelves, single, standing


@dataclass(frozen=True, kw_only=True)
class Kind:
    """A recipe. `always` groups stand in every room of the kind, of `sometimes` each is drawn with its share."""

    name: str
    width_m: tuple[float, float]
    back_m: tuple[float, float]  # from the radar to the wall it looks at
    walls: tuple[str, ...]
    floors: tuple[str, ...]
    always: tuple[Maker, ...]
    sometimes: tuple[tuple[float, Maker], ...]
    num_windows: int = 1


_SMALL = (
    (0.5, single(objects.bin_)),
    (0.5, single(objects.plant)),
    (0.6, hung(objects.picture)),
    (0.5, hung(objects.picture)),
)
_NEAR = (2.9, 3.35)

KINDS: Registry[Kind] = Registry(
    "kind of room",
    [
        (kind.name, kind)
        for kind in (
            Kind(
                name="office", width_m=(3.2, 4.6), back_m=_NEAR, walls=("paint", "concrete"),
                floors=("carpet", "linoleum", "boards"), always=(groups.desk_place, shelves(1)),
                sometimes=((0.7, groups.desk_place), (0.6, single(storage_furniture.pedestal)), (0.4, groups.board),
                *_SMALL),
            ),
            Kind(
                name="living_room", width_m=(3.6, 4.8), back_m=_NEAR, walls=("paint", "brick", "panels"),
                floors=("boards", "carpet"), always=(groups.sofa_place,),
                sometimes=(
                    (0.8, groups.television_place), (0.6, groups.armchair_place), (0.5, shelves(1)),
                    (0.4, standing(objects.rug)), *_SMALL,
                ),
            ),
            Kind(
                name="lab", width_m=(3.6, 5.0), back_m=_NEAR, walls=("paint", "concrete", "tiles"),
                floors=("linoleum", "tiles"), always=(groups.bench_place,),
                sometimes=(
                    (0.8, groups.bench_place), (0.6, groups.desk_place), (0.6, single(storage_furniture.locker)),
                    (0.4, groups.board), (0.5, single(storage_furniture.steel_rack)), (0.5, single(objects.bin_)),
                ),
            ),
            Kind(
                name="kitchen", width_m=(3.2, 4.2), back_m=_NEAR, walls=("paint", "tiles"), floors=("tiles", "boards"),
                always=(groups.kitchen_row,),
                sometimes=((0.7, groups.small_dining), (0.4, groups.kitchen_counter), *_SMALL),
            ),
            Kind(
                name="library", width_m=(3.6, 5.0), back_m=_NEAR, walls=("paint", "panels"),
                floors=("boards", "carpet"),
                always=(shelves(3), shelves(2)),
                sometimes=(
                    (0.7, shelves(2)), (0.7, groups.laptop_desk), (0.6, groups.armchair_place),
                    (0.4, single(objects.floor_lamp)), *_SMALL,
                ),
            ),
            Kind(
                name="bedroom", width_m=(3.4, 4.4), back_m=_NEAR, walls=("paint", "panels"),
                floors=("boards", "carpet"),
                always=(groups.bed_place,),

                sometimes=(
                    (0.7, single(storage_furniture.wardrobe)), (0.6, single(storage_furniture.dresser)), (0.4,
                    groups.laptop_desk),
                    (0.3, groups.armchair_place), *_SMALL,
                ),
            ),
            Kind(
                name="dining_room", width_m=(3.6, 4.8), back_m=_NEAR, walls=("paint", "panels", "brick"),
                floors=("boards", "tiles", "carpet"),
                always=(groups.dining_place,),
                sometimes=(
                    (0.7, single(storage_furniture.dresser)), (0.5, shelves(1)), (0.4, single(objects.floor_lamp)),
                    *_SMALL,
                ),
            ),
            Kind(
                name="meeting_room", width_m=(3.6, 5.0), back_m=(3.0, 3.45), walls=("paint", "concrete", "panels"),
                floors=("carpet", "boards"), always=(groups.meeting_place, groups.television_on_wall),
                sometimes=((0.6, groups.board), (0.5, single(storage_furniture.cabinet)), *_SMALL),
            ),
            Kind(
                name="classroom", width_m=(4.2, 5.4), back_m=(3.2, 3.45), walls=("paint", "concrete"),
                floors=("linoleum", "boards"), always=(groups.teacher, groups.pupils),
                sometimes=((0.5, groups.pupils), (0.6, single(storage_furniture.cabinet)), (0.5, shelves(1)), *_SMALL),
                num_windows=2,
            ),
            Kind(
                name="corridor", width_m=(1.7, 2.4), back_m=(3.2, 5.2), walls=("paint", "brick",
                "concrete"),
                floors=("linoleum", "tiles", "boards"), always=(single(seat_furniture.bench),),
                sometimes=(
                    (0.5, single(storage_furniture.locker)), (0.4, single(storage_furniture.cabinet)), (0.6,
                    single(objects.plant)),
                    (0.7, hung(objects.picture)), (0.6, hung(objects.picture)), (0.4, single(objects.bin_)),
                ),
                num_windows=0,
            ),

            Kind(
                name="gym", width_m=(3.8, 5.2), back_m=_NEAR, walls=("paint", "brick", "concrete"),
                floors=("linoleum", "boards"), always=(groups.treadmill_place, single(storage_furniture.dumbbell_rack)),
                sometimes=(
                    (0.7, standing(seat_furniture.weight_bench)), (0.5, hung(objects.mirror)), (0.6,
                    standing(objects.mat)),
                    (0.4, single(seat_furniture.bench)), (0.3, groups.television_on_wall),
                ),
            ),
            Kind(
                name="workshop", width_m=(3.6, 4.8), back_m=_NEAR, walls=("concrete", "brick", "paint"),
                floors=("concrete",), always=(groups.workbench_place, single(storage_furniture.steel_rack)),
                sometimes=(
                    (0.6, groups.workbench_place), (0.6, single(objects.carton)), (0.5, single(objects.carton)),
                    (0.5, single(storage_furniture.locker)), (0.4, standing(seat_furniture.stool)),
                ),
            ),
        )
    ],
)  # fmt: skip
