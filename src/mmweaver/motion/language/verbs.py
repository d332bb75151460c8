"""Verbs (and nouns derived from them) and the activity that each names."""


def words_in(text: str) -> frozenset[str]:
    """The words of a text, as a set."""
    return frozenset(text.split())


def _all(words: str, lower: str, upper: str = "") -> dict[str, tuple[str, str]]:
    return dict.fromkeys(words.split(), (lower, upper))


# lemma -> (lower, upper) of a Step. Empty lower: arms or head only, overlaid on any body activity.
ACTIVITY_OF_LEMMA: dict[str, tuple[str, str]] = {
    **_all("walk stroll pace stride amble wander saunter step trudge tread strut", "walk"),
    **_all("advance approach retreat", "walk"),
    **_all("jog run sprint trot", "jog"),
    **_all("sidestep", "sidestep"),
    **_all("limp hobble", "limp"),
    **_all("stagger totter sway_along", "stagger"),
    **_all("march", "march"),
    **_all("turn rotate pivot face spin", "turn"),
    **_all("stumble tumble lurch pushed trip", "stumble"),
    **_all("stand wait pause halt stop stay remain freeze idle", "stand"),
    **_all("sit seat seated sit_down", "sit"),
    "stand_up": ("stand_up", ""),
    "squat": ("squat", ""),
    **_all("crouch duck_down", "crouch"),
    "lunge": ("lunge", ""),
    **_all("jump leap", "jump"),
    **_all("hop skip bounce", "hop"),
    "jumping_jack": ("jumping_jacks", ""),
    **_all("one_leg_stand", "one_leg"),
    **_all("kick", "kick"),
    **_all("stomp stamp", "stomp"),
    "bow": ("bow", ""),
    "bend": ("bend", ""),
    "lean_over": ("lean", ""),
    "twist_trunk": ("twist", ""),
    **_all("pick_up", "pick_up"),
    **_all("put_down", "put_down"),
    **_all("dance", "dance"),
    **_all("kneel kneel_down", "kneel"),
    "kneel_up": ("kneel_up", ""),
    **_all("lie lay", "lie"),
    **_all("lie_down", "lie_down"),
    **_all("fall collapse topple faint", "fall"),
    "get_up": ("get_up", ""),
    **_all("wave greet", "", "wave"),
    **_all("clap applaud applause", "", "clap"),
    **_all("raise lift", "", "raise"),
    **_all("arms_out", "", "arms_out"),
    **_all("drink sip gulp swig", "", "drink"),
    **_all("eat dine snack", "", "eat"),
    **_all("type", "", "type"),
    **_all("read", "", "read"),
    **_all("phone telephone", "", "phone"),
    **_all("text", "", "text"),
    **_all("brush_teeth", "", "brush_teeth"),
    **_all("comb_hair", "", "comb"),
    **_all("wipe clean scrub polish dust", "", "wipe"),
    **_all("write scribble draw_on", "", "write"),
    **_all("stir whisk", "", "stir"),
    **_all("knock", "", "knock"),
    **_all("open_door", "", "open_door"),
    **_all("play_guitar strum", "", "guitar"),
    **_all("play_violin fiddle", "", "violin"),
    **_all("point", "", "point"),
    **_all("nod", "", "nod"),
    **_all("shake_head", "", "shake_head"),
    **_all("look_around", "", "look_around"),
    **_all("cross_arms", "", "cross_arms"),
    **_all("hands_on_hips", "", "hips"),
    **_all("shrug", "", "shrug"),
    **_all("stretch", "", "stretch"),
    **_all("circle_arms", "", "arm_circles"),
    **_all("punch box jab shadowbox uppercut", "", "punch"),
    **_all("throw toss hurl lob", "", "throw"),
    **_all("push shove", "", "push"),
    **_all("pull tug", "", "pull"),
    **_all("carry", "", "carry"),
    **_all("reach grab grasp fetch", "", "reach"),
    **_all("play_golf", "", "golf"),
    "side_lunge": ("side_lunge", ""),
    "limb_extension": ("limb_extension", ""),
    "push_up": ("push_ups", ""),
    "fall_off": ("fall_off", ""),
    "step_up_and_down": ("stairs", ""),
    "tree_pose": ("tree_pose", ""),
    "warrior_pose": ("warrior_pose", ""),
    "downward_dog": ("downward_dog", ""),
    "hold_plank": ("plank", ""),
    "crawl": ("crawl", ""),
    "raise_and_hold": ("", "raise_hold"),
    "lower_arm": ("", "lower_arm"),
    "push_hand": ("", "push_hand"),
    "pull_hand": ("", "pull_hand"),
    "draw_circle": ("", "draw_circle"),
    "draw_letter_z": ("", "draw_z"),
    "yawn": ("", "yawn"),
    "knock_elbow": ("", "knock_elbow"),
    "arm_extension": ("", "arm_extension"),
    "hands_up": ("", "hands_up"),
    **_all("sweep mop rake", "", "sweep"),
    **_all("vacuum hoover", "", "vacuum"),
    "jacket_off": ("", "jacket_off"),
    **_all("cough", "", "cough"),
    "breathe_deeply": ("", "breathe"),
}  # fmt: skip

# Words that follow a push and only say that the person recovers.
RECOVERING = words_in(
    """
    recover recovers recovering compensate compensates compensating counterbalance counterbalances regain regains
    regaining balances balancing catches catch stabilize stabilizes
    """
)
