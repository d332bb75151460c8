"""The one table of activities: name, example sentence, duration, free floor needed. Add an activity here first."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Activity:
    """One activity. A body activity moves legs and trunk, a hand activity is overlaid on one."""

    key: str
    name: str  # as in "walking and waving"
    example: str
    least_s: float  # shortest time in which it can be shown
    natural_s: float
    once: bool = False  # takes its natural time; time that is left goes to other steps
    counted_s: tuple[float, float, float] | None = None  # of one repetition: least, natural; extra at start and end
    clearance_m: float = 0.5  # free floor around the body
    moves: bool = False  # changes the position on the floor
    hands: bool = False
    posture: str = "feet"  # what the body rests on at its end: feet | seat | couch | knees | floor
    uses_seat: bool = False  # needs a seat, bed or couch


def _body(key: str, name: str, example: str, least_s: float, natural_s: float, **more) -> Activity:
    return Activity(key=key, name=name, example=example, least_s=least_s, natural_s=natural_s, **more)


def _hands(key: str, name: str, example: str, least_s: float, natural_s: float, **more) -> Activity:
    return Activity(key=key, name=name, example=example, least_s=least_s, natural_s=natural_s, hands=True, **more)


BODY: tuple[Activity, ...] = (
    _body("stand", "standing", "a person stands still", 0.3, 1.0, clearance_m=0.35),
    _body("walk", "walking", "a person walks towards the radar", 0.8, 2.0, counted_s=(0.5, 0.58, 0.3), clearance_m=0.3,
          moves=True),
    _body("jog", "jogging", "a person runs to the left", 0.8, 2.0, counted_s=(0.36, 0.4, 0.3), moves=True),
    _body("sidestep", "sidestepping", "a person takes two steps sideways to the right", 0.8, 1.6,
          counted_s=(0.6, 0.75, 0.3), clearance_m=0.3, moves=True),
    _body("limp", "limping", "a person limps", 1.2, 2.4, counted_s=(0.6, 0.7, 0.3), clearance_m=0.3, moves=True),
    _body("stagger", "staggering", "a drunk person staggers", 1.4, 2.6, counted_s=(0.6, 0.7, 0.3), clearance_m=0.4,
          moves=True),
    _body("march", "marching on the spot", "a person marches on the spot", 0.8, 2.0, counted_s=(0.45, 0.52, 0.3)),
    _body("turn", "turning", "a person turns around", 0.7, 1.2, once=True, clearance_m=0.4),
    _body("stumble", "stumbling", "a person is pushed from behind and stumbles", 1.0, 1.5, once=True, clearance_m=0.4,
          moves=True),
    _body("sit", "sitting", "a person sits on the couch", 0.4, 1.5, clearance_m=0.4, posture="seat",
          uses_seat=True),
    _body("sit_down", "sitting down", "a person sits down", 0.95, 1.6, once=True, posture="seat", uses_seat=True),
    _body("stand_up", "standing up", "a person stands up from the chair", 0.9, 1.4, once=True, uses_seat=True),
    _body("squat", "squatting", "a person does three squats", 1.1, 2.0, counted_s=(1.1, 2.0, 0.0), clearance_m=0.6),
    _body("crouch", "crouching", "a person crouches down", 1.0, 2.0, clearance_m=0.6),
    _body("lunge", "lunging", "a person does a lunge", 1.6, 2.4, counted_s=(1.6, 2.2, 0.1), clearance_m=0.8),
    _body("jump", "jumping", "a person jumps twice", 1.45, 1.7, counted_s=(0.92, 1.0, 0.6)),
    _body("leap", "jumping somewhere", "a person jumps forward", 1.45, 1.8, counted_s=(0.92, 1.0, 0.6), moves=True),
    _body("hop", "hopping", "a person hops in place", 1.0, 2.0, counted_s=(0.42, 0.5, 0.6)),
    _body("hop_one_leg", "hopping on one leg", "a person hops on the left leg", 1.6, 2.6, counted_s=(0.45, 0.52, 1.1),
          clearance_m=0.6),
    _body("jumping_jacks", "jumping jacks", "a person does jumping jacks", 1.0, 2.1, counted_s=(0.92, 1.1, 0.35),
          clearance_m=0.85),
    _body("one_leg", "standing on one leg", "a person stands on one leg", 1.6, 3.0, clearance_m=0.6),
    _body("kick", "kicking", "a person kicks with the right foot", 1.0, 1.5, counted_s=(1.0, 1.4, 0.1), once=True,
          clearance_m=0.9),
    _body("stomp", "stamping", "a person stamps with the left foot", 0.8, 1.2, counted_s=(0.7, 0.9, 0.1), once=True),
    _body("raise_leg", "raising a leg", "a person lifts the left leg", 1.3, 2.0, counted_s=(1.3, 1.8, 0.1), once=True,
          clearance_m=0.6),
    _body("bow", "bowing", "a person bows", 1.3, 2.2, counted_s=(1.3, 2.0, 0.0), once=True, clearance_m=0.6),
    _body("bend", "bending down", "a person bends down", 1.4, 2.4, counted_s=(1.4, 2.2, 0.0), once=True,
          clearance_m=0.7),
    _body("lean", "leaning", "a person leans to the left", 1.2, 2.2, counted_s=(1.2, 2.0, 0.0), once=True,
          clearance_m=0.6),
    _body("twist", "twisting the trunk", "a person twists the upper body", 1.4, 2.8, counted_s=(1.2, 2.2, 0.2),
          clearance_m=0.5),
    _body("pick_up", "picking up", "a person picks something up from the floor", 1.6, 2.4, counted_s=(1.6, 2.4, 0.0),
          once=True, clearance_m=0.7),
    _body("put_down", "putting down", "a person puts a box down on the floor", 1.6, 2.4, counted_s=(1.6, 2.4, 0.0),
          once=True, clearance_m=0.7),
    _body("dance", "dancing", "a person dances", 1.2, 4.0, clearance_m=0.7),
    _body("kneel_down", "kneeling down", "a person kneels down", 1.4, 2.0, once=True, clearance_m=0.7, posture="knees"),
    _body("kneel", "kneeling", "a person is kneeling", 0.4, 1.5, clearance_m=0.7, posture="knees"),
    _body("kneel_up", "standing up from the knees", "a kneeling person stands up", 1.4, 2.0, once=True,
          clearance_m=0.7),
    _body("lie_down", "lying down", "a person lies down on the floor", 2.4, 3.4, once=True, posture="floor"),
    _body("fall", "falling", "a person falls down", 1.3, 1.7, once=True, posture="floor"),
    _body("lie", "lying", "a person lies on the floor", 0.4, 2.0, posture="floor"),
    _body("get_up", "getting up from the floor", "a person lying on the floor gets up", 2.6, 3.6, once=True),
    _body("side_lunge", "lunging to the side", "a person does side lunges with the left leg", 1.4, 3.0,
          counted_s=(1.4, 2.8, 0.1), clearance_m=0.9),
    _body("limb_extension", "extending a leg and an arm", "a person extends the left arm and leg to the side", 1.3, 2.8,
          counted_s=(1.3, 2.6, 0.1), clearance_m=0.9),
    _body("push_ups", "push-ups", "a person does push-ups", 1.0, 4.0, counted_s=(0.9, 1.8, 0.2), clearance_m=0.6,
          posture="floor"),
    _body("sit_ups", "sit-ups", "a person does sit-ups", 1.6, 5.0, counted_s=(1.4, 2.4, 0.2), clearance_m=0.6,
          posture="floor"),
    _body("roll_over", "rolling onto a side and back", "a person lying on the floor rolls over", 1.6, 3.4,
          counted_s=(1.6, 3.2, 0.1), clearance_m=0.6, posture="floor"),
    _body("lie_on_seat", "lying on furniture", "a person lies on the sofa", 0.4, 2.0, posture="couch", uses_seat=True),
    _body("recline", "lying down on furniture", "a person lies down on the bed", 1.6, 2.4, once=True, posture="couch",
          uses_seat=True),
    _body("sit_up", "sitting up on furniture", "a person lying on the bed sits up", 1.6, 2.2, once=True, posture="seat",
          uses_seat=True),
    _body("roll_in_bed", "rolling onto a side and back on furniture", "a person rolls over in bed", 1.6, 3.4,
          counted_s=(1.6, 3.2, 0.1), posture="couch", uses_seat=True),
    _body("fall_off", "falling off a seat", "a person falls off the chair", 1.1, 1.5, once=True, posture="floor",
          uses_seat=True),
    _body("stairs", "stepping up and down", "a person steps up and down", 1.8, 4.6, counted_s=(1.8, 2.3, 0.1),
          clearance_m=0.6),
    _body("tree_pose", "the tree pose", "a person stands in the tree pose", 1.8, 5.0, clearance_m=0.6),
    _body("warrior_pose", "the warrior pose", "a person holds the warrior pose", 1.6, 5.0, clearance_m=1.0),
    _body("downward_dog", "the downward dog", "a person does the downward dog", 1.8, 5.0, clearance_m=0.9),
    _body("plank", "holding a plank", "a person holds a plank", 0.6, 4.0, posture="floor"),
    _body("crawl", "crawling", "a person crawls to the left", 1.0, 3.0, clearance_m=0.5, moves=True, posture="knees"),
    _body("roundhouse", "a roundhouse kick", "a person does a roundhouse kick", 1.2, 1.7, counted_s=(1.2, 1.6, 0.1),
          once=True, clearance_m=1.0),
    _body("side_kick", "kicking to the side", "a person does a side kick", 1.2, 1.7, counted_s=(1.2, 1.6, 0.1),
          once=True, clearance_m=1.0),
    _body("walking_lunge", "walking lunges", "a person does walking lunges", 2.0, 4.0, counted_s=(1.15, 1.45, 0.5),
          clearance_m=0.4, moves=True),
    _body("forward_roll", "a forward roll", "a person does a forward roll", 2.6, 3.2, counted_s=(2.6, 2.95, 0.2),
          once=True, clearance_m=0.6, moves=True),
    _body("hula_hoop", "circling the hips", "a person hula hoops", 1.2, 4.0, clearance_m=0.6),
    _body("pedal", "riding an exercise bike", "a person pedals on an exercise bike", 2.4, 6.0, clearance_m=0.6),
)  # fmt: skip

HANDS: tuple[Activity, ...] = (
    _hands("wave", "waving", "a person waves with both hands", 0.8, 1.8, counted_s=(0.45, 0.75, 0.3), clearance_m=0.6),
    _hands("clap", "clapping", "a person claps three times", 0.6, 1.6, counted_s=(0.32, 0.5, 0.25), clearance_m=0.45),
    _hands("raise", "raising", "a person raises the left hand", 1.1, 2.2, counted_s=(1.1, 2.0, 0.0)),
    _hands("arms_out", "holding the arms out", "a person stretches both arms out to the sides", 1.0, 2.0,
           clearance_m=0.9),
    _hands("drink", "drinking", "a person drinks", 1.4, 2.8, counted_s=(1.4, 2.6, 0.0), clearance_m=0.4),
    _hands("eat", "eating", "a person sits and eats", 1.4, 3.0, counted_s=(1.2, 2.0, 0.2), clearance_m=0.4),
    _hands("type", "typing", "a person sits at the desk and types", 0.6, 2.0, clearance_m=0.4),
    _hands("read", "reading", "a person reads a book on the sofa", 0.6, 2.5, clearance_m=0.4),
    _hands("phone", "phoning", "a person talks on the phone", 1.2, 2.5, clearance_m=0.4),
    _hands("text", "using a phone", "a person looks at the phone while walking", 0.8, 2.0, clearance_m=0.4),
    _hands("brush_teeth", "brushing teeth", "a person brushes the teeth", 0.8, 2.0, clearance_m=0.4),
    _hands("comb", "combing", "a person combs the hair", 1.0, 2.4, clearance_m=0.45),
    _hands("wipe", "wiping", "a person wipes the table", 0.8, 2.2, clearance_m=0.6),
    _hands("write", "writing", "a person writes on a board", 0.8, 2.2, clearance_m=0.5),
    _hands("stir", "stirring", "a person stirs the soup", 0.8, 2.2, clearance_m=0.5),
    _hands("knock", "knocking", "a person knocks on the door", 0.9, 1.6, counted_s=(0.28, 0.36, 0.7)),
    _hands("open_door", "opening a door", "a person opens the door", 1.6, 2.4, once=True, clearance_m=0.6),
    _hands("guitar", "playing the guitar", "a person plays the guitar", 0.8, 2.2),
    _hands("violin", "playing the violin", "a person plays the violin", 0.8, 2.2),
    _hands("point", "pointing", "a person points to the left", 1.1, 1.8, counted_s=(1.1, 1.6, 0.0), clearance_m=0.6),
    _hands("nod", "nodding", "a person nods", 0.7, 1.4, counted_s=(0.5, 0.65, 0.2), clearance_m=0.35),
    _hands("shake_head", "shaking the head", "a person shakes the head", 0.7, 1.5, counted_s=(0.6, 0.75, 0.2),
           clearance_m=0.35),
    _hands("look_around", "looking around", "a person looks around", 1.0, 2.4, clearance_m=0.35),
    _hands("cross_arms", "crossing the arms", "a person stands with crossed arms", 1.0, 2.0, clearance_m=0.4),
    _hands("hips", "hands on the hips", "a person puts the hands on the hips", 0.9, 2.0, clearance_m=0.5),
    _hands("shrug", "shrugging", "a person shrugs", 0.9, 1.4, counted_s=(0.9, 1.2, 0.0), once=True, clearance_m=0.45),
    _hands("stretch", "stretching", "a person stretches", 1.6, 3.0, once=True, clearance_m=0.7),
    _hands("arm_circles", "circling the arms", "a person circles the arms", 0.9, 2.2, counted_s=(0.8, 1.1, 0.2),
           clearance_m=0.9),
    _hands("punch", "punching", "a person boxes", 0.55, 1.5, counted_s=(0.42, 0.6, 0.1), clearance_m=0.75),
    _hands("throw", "throwing", "a person throws a ball", 1.2, 1.7, counted_s=(1.2, 1.6, 0.1), once=True,
           clearance_m=0.9),
    _hands("push", "pushing", "a person pushes something away", 1.1, 1.7, counted_s=(1.1, 1.5, 0.1), once=True,
           clearance_m=0.8),
    _hands("pull", "pulling", "a person pulls a rope", 1.1, 1.7, counted_s=(1.0, 1.4, 0.1), clearance_m=0.8),
    _hands("carry", "carrying", "a person carries a box to the right", 0.6, 2.0, clearance_m=0.5),
    _hands("reach", "reaching", "a person takes a cup from the table", 1.1, 1.8, counted_s=(1.1, 1.6, 0.0), once=True,
           clearance_m=0.6),
    _hands("golf", "a golf swing", "a person plays golf", 1.6, 2.2, counted_s=(1.6, 2.2, 0.0), once=True,
           clearance_m=1.0),
    _hands("raise_hold", "lifting an arm and keeping it up", "a person lifts the right arm straight up and keeps it up",
           0.8, 2.0, once=True),
    _hands("lower_arm", "lowering an arm", "a person lets the right arm fall straight down", 0.8, 2.0, once=True),
    _hands("push_hand", "pushing a hand forward", "a person pushes the right hand forward from the chest", 0.8, 2.0,
           once=True, clearance_m=0.7),
    _hands("pull_hand", "pulling a hand to the chest", "a person pulls the right hand back to the chest", 0.8, 2.0,
           once=True, clearance_m=0.7),
    _hands("draw_circle", "drawing a circle in the air", "a person draws a large circle with the right arm", 1.0, 2.5,
           counted_s=(0.9, 2.2, 0.2), clearance_m=0.8),
    _hands("draw_z", "drawing a Z in the air", "a person draws a large Z with the right arm", 1.2, 2.5, once=True,
           clearance_m=0.8),
    _hands("yawn", "yawning", "a person yawns", 1.0, 2.4, once=True, clearance_m=0.45),
    _hands("knock_elbow", "raising a forearm", "a person raises the right hand from the elbow twice", 0.6, 1.2,
           counted_s=(0.45, 0.9, 0.1), clearance_m=0.5),
    _hands("arm_extension", "extending an arm upwards at the side", "a person extends the left arm up at the side", 1.1,
           4.0, counted_s=(1.1, 4.0, 0.1), clearance_m=0.8),
    _hands("hands_up", "holding the hands up", "a person does squats with the hands up", 0.8, 2.0, clearance_m=0.6),
    _hands("sweep", "sweeping", "a person sweeps the floor", 1.0, 3.0, clearance_m=0.7),
    _hands("vacuum", "vacuuming", "a person vacuums", 1.0, 3.0, clearance_m=0.8),
    _hands("jacket_off", "taking a jacket off", "a person takes off a jacket", 2.0, 3.6, once=True, clearance_m=0.7),
    _hands("cough", "coughing", "a person sits and coughs", 0.9, 2.2, counted_s=(0.9, 2.0, 0.2), clearance_m=0.4),
    _hands("tremble", "trembling", "a person trembles with cold", 1.0, 3.0, clearance_m=0.4),
    _hands("cradle", "rocking a baby", "a person rocks a baby", 1.2, 4.0, clearance_m=0.5),
    _hands("swipe", "swiping a hand through the air", "a person swipes the right hand to the left", 0.7, 1.4,
           counted_s=(0.55, 1.0, 0.2), clearance_m=0.7),
    _hands("count_fingers", "counting on the fingers", "a person counts on the fingers", 1.4, 3.5,
           counted_s=(0.45, 0.7, 0.8), clearance_m=0.45),
    _hands("jab", "a jab", "a boxer throws a jab", 0.6, 0.7, counted_s=(0.54, 0.58, 0.1), once=True,
           clearance_m=0.75),
    _hands("cross", "a cross", "a boxer throws a right cross", 0.65, 0.8, counted_s=(0.62, 0.68, 0.1), once=True,
           clearance_m=0.75),
    _hands("hook", "a hook", "a boxer throws a hook", 0.8, 0.95, counted_s=(0.8, 0.88, 0.05), once=True,
           clearance_m=0.75),
    _hands("uppercut", "an uppercut", "a boxer throws an uppercut", 0.8, 0.95, counted_s=(0.81, 0.9, 0.05), once=True,
           clearance_m=0.75),
    _hands("forehand", "a forehand", "a person hits a forehand", 1.4, 1.8, counted_s=(1.4, 1.7, 0.1), once=True,
           clearance_m=0.9),
    _hands("backhand", "a backhand", "a person hits a backhand", 1.4, 1.8, counted_s=(1.4, 1.7, 0.1), once=True,
           clearance_m=0.9),
    _hands("tennis_serve", "a tennis serve", "a person serves a tennis ball", 1.8, 2.3, counted_s=(1.8, 2.2, 0.1),
           once=True, clearance_m=1.0),
    _hands("breathe", "breathing deeply", "a person sits and breathes deeply", 1.0, 5.0, clearance_m=0.35),
)  # fmt: skip

BY_KEY: dict[str, Activity] = {activity.key: activity for activity in (*BODY, *HANDS)}
CLEARANCE_M: dict[str, float] = {key: activity.clearance_m for key, activity in BY_KEY.items()}


def known() -> str:
    """All names, separated by commas, for messages.

    >>> known().count(", ") > 50
    True
    """
    return ", ".join(activity.name if activity.key != "raise" else "raising a hand" for activity in BY_KEY.values())
