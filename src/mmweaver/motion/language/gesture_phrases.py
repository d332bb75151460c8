"""Phrases of exercises and arm gestures, as instructions word them, replaced by one token each.

The gestures are those of mHomeGes, the exercises those of MARS; both are worded in many ways.
"""

_OWN = r"(?:(?:his|her|its|their|the|both|straight|stretched|own|an?|one) )*"
_SIDE = r"((?:left |right )?)"
_ARM = r"(arms?|hands?)"
_UP = r"(?:straight up|all the way up|up(?:wards?)?)"
_STAYS = (
    r"(?:,? (?:and|then) (?:it |they |(?:keeps|holds|leaves) (?:it|them) )?(?:stays?|there|up there|up|raised|in place)"
    r"(?: (?:up|there))?(?: ?(?:straight )?(?:above|over) (?:the|his|her|their) heads?)?"
    r"|,? (?:and|then) (?:keeps|holds|leaves) (?:it|them)(?: ?(?:straight )?(?:above|over) (?:the|his|her|their) heads?))"
)
_OF_LEG = r"(?:with|on|to|onto) (?:the |his |her |their )?(left|right)(?: leg| foot| side)?"
_LUNGE = r"(?:side|lateral|sideways?)[- ]?lunge"

# Replaced in this order, before `phrases.ACTIVITY_PHRASES`.
GESTURE_PHRASES: tuple[tuple[str, str], ...] = (
    # Seats, stairs and poses
    (r"\b(falls?|slips?|slides?|tumbles?|drops?) (slowly|suddenly|gently|quickly) (?=(?:off|from|out of|down)\b)", r" \2 \1 "),
    (r"\b(?:falls?|falling|slips?|slipping|slides?|tumbles?|drops?) (?:down )?(?:off|from|out of|down from)(?: of)? (?:the |a |his |her |their )?"
     r"(chair|stool|sofa|couch|bed|bench|seat|armchair)\b", r" fall_off \1 "),
    (r"\bsteps? up and (?:then )?(?:steps? )?(?:back )?down(?: again)?\b|\bstepping up and down\b|\bstep[- ]ups?\b"
     r"|\bsteps? (?:up )?on(?:to)? an? (?:small |low )?(?:box|stepper|aerobic step) and (?:back )?down(?: again)?\b", " step_up_and_down "),
    (r"\b(?:(?:stands?|standing|holds?|holding|goes|gets|is|does|doing|keeps) )?(?:in |into |the |a |an |yoga )*tree[- ]pose\b", " tree_pose "),
    (r"\b(?:(?:stands?|standing|holds?|holding|goes|gets|is|does|doing|keeps) )?(?:in |into |the |a |an |yoga )*warrior(?:[- ](?:one|two|1|2|i|ii))?[- ](?:pose|position)\b", " warrior_pose "),
    (r"\b(?:(?:stands?|standing|holds?|holding|goes|gets|is|does|doing|keeps) )?(?:in |into |the |a |an |yoga )*down(?:ward|wards)?(?:[- ]facing)?[- ]dog(?:[- ](?:pose|position))?\b", " downward_dog "),
    (r"\b(?:holds?|does|doing|holding|in|is in) (?:an? |the )?(?:forearm |high )?plank(?: pose| position)?\b|\bplanks\b|\bplanking\b"
     r"|(?:^|(?<=, )|(?<=then )|(?<=and ))plank(?= for\b| *[,.]| *$)", " hold_plank "),
    (r"\b(?:carr(?:y|ies|ying)) (?:an? |the |some |two |his |her )(?:[a-z]+ )?(?:box|boxes|crate|parcel|tray|bag|suitcase|chair|bucket|basket|pile|stack)(?:es|s)?"
     r"(?: of [a-z]+)?\b", " carry a thing "),
    # Exercises
    (rf"\b{_LUNGE}(?:s|d|ing)? {_OF_LEG}\b", r" side_lunge \1_leg "),
    (rf"\b(left|right) {_LUNGE}(?:s|d|ing)?\b", r" side_lunge \1_leg "),
    (rf"\b{_LUNGE}s\b", " side_lunges "), (rf"\b{_LUNGE}(?:d|ing)?\b", " side_lunge "),
    (r"\blung(?:es?|ing) (?:sideways|to (?:the |his |her |their )?(left|right|side)s?(?: side)?)\b", r" side_lunge \1 leg "),
    (r"\b(left|right) front(?:al)?[- ]lunges?\b|\bfront(?:al)?[- ]lunges? (?:with (?:the )?)?(left|right)(?: leg)?\b",
     r" frontlunge lunges \1\2_leg "),
    (r"\bfront(?:al)?[- ]lunge(s?)\b", r" frontlunge lunge\1 "),
    (rf"\b(?:extends?|extending|rais(?:es|ing)|lifts?|lifting) {_OWN}(left|right) arm and {_OWN}(?:same |\1 )?leg"
     r"(?: (?:out )?(?:to the side|sideways))?\b", r" limb_extension \1_leg "),
    (rf"\b(?:extends?|extending|rais(?:es|ing)|lifts?|lifting) {_OWN}(left|right) leg and {_OWN}(?:same |\1 )?arm"
     r"(?: (?:out )?(?:to the side|sideways))?\b", r" limb_extension \1_leg "),
    (r"\b(left|right) limb extensions?\b", r" limb_extension \1_leg "),
    (r"\b(left|right|both) upper[- ]limbs? extensions?\b", r" arm_extension \1 arm "),
    (rf"\b(?:extends?|extending|rais(?:es|ing)|lifts?|lifting) ({_OWN}){_SIDE}arms? (?:up (?:at|to|along)|up from) "
     r"(?:the |his |her |their |its |both )*sides?\b", r" arm_extension \1 \2 arm "),
    (rf"\bwith {_OWN}hands (?:held |raised )?up\b", " while hands_up "),
    (r"\b(?:an?|one) (?:push|press)[- ]?up\b", " 1 push_up "), (r"\b(?:push|press)[- ]?ups?\b", " push_up "),
    (r"\b(?:an?|one) sit[- ]?up\b", " 1 sit_up_exercise "),
    (r"\b(?:sit-ups?|situps?|sit ups|(?:ab(?:dominal)? )?crunch(?:es)?)\b", " sit_up_exercise "),
    (r"\b(?:shak(?:es|ing)|trembl(?:es|ing)|shiver(?:s|ing)|quiver(?:s|ing)) (?:all over|(?:all over )?(?:with|from|for|in|because of) (?:the |his |her )?"
     r"(?:cold|fear|fright|fever|anger|rage|excitement|exhaustion))\b", " tremble "),
    (r"\b(?:has|with|having) (?:a |an )?(?:strong |slight )?tremors?\b", " tremble "),
    (r"\b(?:the |his |her |its |their |both )+(?:hands?|arms?|body|limbs) (?:trembl|shiver|quiver|shak)(?:es|s|e|ing)\b", " trembles "),
    (rf"\b(?:hold|carr|cradl|rock|sooth|comfort|nurs|lull|swing)(?:s|es|ies|ing|ying) {_OWN}(?:[a-z]+ )?(?:baby|infant|newborn)\b"
     r"(?! (?:stroller|carriage|seat|to (?!sleep)|towards?|through|across|away|around|over|forwards?|up|down|into|out|upstairs|downstairs))"
     r"(?: (?:to sleep|back and forth|to and fro|gently|softly|from side to side|(?:in|on) (?:his|her|their|the) (?:arms?|chest|lap))\b)*", " cradle "),
    (r"\bwhile on (?:the |his |her )?phone\b", " while phone "),
    (r"\bcrawl(?:s|ing|ed)?((?: (?!on\b|and\b|then\b)[a-z]+){0,3}) on (?:his |her |the |all )*(?:hands and knees|fours)\b", r" crawls\1 "),
    # Gestures of one arm; the arm may be what acts: "the right arm falls straight down"
    (r"\b(?:the |his |her |its )?(?:straight )?(left|right) (arm|hand) (?:is lifted|is raised|rises|goes) straight up"
     r"(?:,? (?:and )?stays (?:up|there|above the head))?\b", r" raise_and_hold \1 \2 "),
    (r"\bboth (arms|hands) (?:are lifted|are raised|rise|go) straight up(?:,? (?:and )?stay (?:up|there|above the head))?\b",
     r" raise_and_hold both \1 "),
    (r"\b(?:the |his |her |its )?(?:straight )?(left|right) (arm|hand) (?:falls|sinks|drops|goes) (?:straight )?down"
     r"(?:,? (?:and )?stays down)?\b", r" lower_arm \1 \2 "),
    (r"\b(?:the |his |her |its )?(left|right) (?:hand|palm) (?:is (?:stretched|pushed) )(?:straight )?(?:forwards?|ahead)\b"
     r"(?:,? (?:and )?(?:the (?:left |right )?(?:arm|hand) |it )?stays straight\b)?",
     r" push_hand \1 hand "),
    (r"\b(?:the |his |her |its )?(left|right) (?:hand|palm) (?:returns|comes back|goes back) to (?:the|his|her) chest\b",
     r" pull_hand \1 hand "),
    (r"\b(?:the |his |her |its )?(left|right) (?:hand|palm) covers (?:the|his|her) mouth\b", r" yawns \1 hand "),
    (r"\b(?:the |his |her |its )?(?:straight )?(left|right) (?:arm|hand) draws ([^,.;]*\b(?:circle|z))\b",
     r" draws \2 with the \1 arm "),
    (rf"\b(?:lifts?|lifting|rais(?:es|ing)) {_OWN}{_SIDE}{_ARM} {_UP}(?:{_STAYS})?\b", r" raise_and_hold \1 \2 "),
    (rf"\b(?:lifts?|lifting|rais(?:es|ing)) {_OWN}{_SIDE}{_ARM} straight up(?! and down)\b", r" raise_and_hold \1 \2 "),
    (rf"\b(?:lowers?|lowering|drops|lets) {_OWN}{_SIDE}{_ARM} (?:from above (?:the|his|her) head )?(?:fall |drop |sink )?"
     r"(?:straight )?down(?: and (?:it|they) stays? down)?\b", r" lower_arm \1 \2 "),
    (rf"\b(?:push(?:es|ing)?|stretch(?:es|ing)?|moves?) {_OWN}{_SIDE}(hand|palm) (?:straight )?(?:forwards?|ahead|out)"
     r"(?: from (?:the|his|her) chest)?\b", r" push_hand \1 hand "),
    (rf"\b(?:pull(?:s|ing)?|draws?|drawing|brings|moves?|returns?) {_OWN}{_SIDE}(hand|palm) (?:back )?to "
     r"(?:the|his|her|their) chest\b", r" pull_hand \1 hand "),
    (rf"\b(?:draw(?:s|ing)?|makes?|traces?|paints?) (?:an? |one )?(?:large |big |clockwise )*circles?"
     rf"(?: in the air| before (?:the|his|her) body| in front of (?:the|his|her) body)*(?: with {_OWN}{_SIDE}(?:arm|hand))?\b",
     r" draw_circle \1 hand "),
    (rf"\b(?:draw(?:s|ing)?|writes?|makes?|traces?|paints?) (?:an? |the |one )?(?:large |big |letter )*[\"']?z[\"']?"
     rf"(?: in the air| before (?:the|his|her) body| in front of (?:the|his|her) body)*(?: with {_OWN}{_SIDE}(?:arm|hand))?(?!\w)",
     r" draw_letter_z \1 hand "),
    (rf"\bcovers? {_OWN}mouth(?: with {_OWN}{_SIDE}hand)?(?:,? (?:and|while) yawn(?:s|ing))?\b", r" yawns \1 hand "),
    (rf"\byawn(?:s|ing)(?:,| and| while)+ cover(?:s|ing) {_OWN}mouth(?: with {_OWN}{_SIDE}hand)?\b", r" yawns \1 hand "),
    (rf"\b(?:rais(?:es|ing)|lifts?) {_OWN}{_SIDE}(?:hand|forearm) from {_OWN}elbow"
     r"(?: and (?:(?:lowers|puts) it(?: down)?|(?:back )?down(?: again)?))?\b",
     r" knock_elbow \1 hand "),
    (r"\b(?:makes?|does|performs?|making|doing) (?:an? )?swip(?:ing|e) (?:gestures?|motions?|movements?)\b", " swipes "),
    (rf"\bswip(?:es?|ing) (?:{_OWN}{_SIDE}(?:hand|arm|palm|fingers?) )?(?:(?:from )?(?:the )?(?:left|right) to )?(?:to |towards )?(?:the )?"
     r"(left|right)\b", r" swipes to the \2 with the \1 hand "),
    *((rf"\bswip(?:es?|ing) (?:{_OWN}{_SIDE}(?:hand|arm|palm|fingers?) )?(?:from (?:the )?(?:bottom|top|below|above) to (?:the )?)?{ends}(?:wards?)?\b",
       rf" swipe_{way} with the \1 hand ") for way, ends in (("up", "(?:up|top)"), ("down", "(?:down|bottom)"))),
    (r"\bcount(?:s|ing)? (?:up )?(?:from (?:one|1) )?to (\w+) (?:on|with|using) (?:the |his |her |their )?(?:own )?fingers\b", r" count_fingers \1 times "),
    (r"\bcount(?:s|ing)? (?:on|with|using) (?:the |his |her |their )?(?:own )?fingers\b", " count_fingers "),
    # Housework and breath
    (r"\b(?:takes?|taking) (?:off )?(?:his |her |its |their |the |an? )?(?:jacket|coat|sweater|pullover)(?: off)?\b"
     r"|\b(?:pull|put)(?:s|ting|ing)? (?:off (?:his |her |its |their |the |an? )?(?:jacket|coat|sweater|pullover)"
     r"|(?:his |her |its |their |the |an? )?(?:jacket|coat|sweater|pullover) off)\b",
     " jacket_off "),
    (r"\b(?:sweep(?:s|ing)?|mop(?:s|ping)?|rak(?:es|ing)) (?:up )?(?:the )?(?:floor|room|kitchen|leaves)\b", " sweeps "),
    (r"\b(?:vacuum(?:s|ing)?|hoover(?:s|ing)?)(?: cleans?)?(?: the)?(?: floor| carpet| room| rug)?\b", " vacuums "),
    (r"\bbreath(?:e?s|ing) (?:deeply|heavily|slowly|calmly|in and out)\b|\b(?:takes?|taking|took) (?:a |some )?deep breaths?\b|\bbreath(?:es|ing)\b",
     " breathe_deeply "),
)  # fmt: skip
