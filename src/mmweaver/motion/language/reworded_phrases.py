"""Rewordings of a sentence before anything else of it is read: a few words that mean one thing only together."""

import re
from collections.abc import Callable

_OWN = r"(?:(?:the|his|her|their|its) )"
_TO = rf"(?:to (?:{_OWN})?|towards {_OWN}?)?"
_GAIT = r"(?:walk|run|jog|mov|go|step|head|march|stroll)(?:s|es|ing|ning|ging|ping|ed)?"
_SLIGHTLY = r"(?:slightly|a (?:little )?bit|a little|somewhat)"
_ENDS = r"(?= *(?:$|[.,;]| and\b| then\b| before\b))"
_DOWN = r"(?:go(?:es|ing)?|gets?|getting|drops?|dropping|sinks?|sinking|comes?|lower(?:s|ing)?(?: (?:him|her|them)self)?|falls?)"
_ONWARD = r"(?:return|go|come|walk|run|jog|turn|sit|stand|jump|step|move|start|stop|wave|bend|kneel)"  # "and after return back"
_WALKS = r"(?:walk|run|jog|march|stroll|mov)(?:s|es|ing|ning|ging|ping)"
_WALK_ALONE = (
    rf"{_WALKS}(?: (?!(?:to|and|then|until|times|steps?|while|with)\b)[a-z]+){{0,5}}?"  # to no place, and not counted
)
_A_SHORT = r"(?:an?|some) (?:(?:short|brief|long|little|small|quick|slight) )*"
_T_POSE = r"(?:(?:an?|the|his|her|their) )?t[- ]?pose\b(?: position)?"
_ADVERBS = r"(?: (?:back|slowly|quickly|carefully|gently))*"


def _limps(found: re.Match[str]) -> str:
    limp = "limping" if found["ending"] == "ing" else "limps"
    return f"{limp}{found['way']}" + (f" with the {found['side']} leg" if found["side"] else "")


def _left_then_right(found: re.Match[str]) -> str:
    limb = {"feet": "foot"}.get(found["limb"], found["limb"].removesuffix("s"))
    often = found["often"] or ""
    verb = f"{found['verb']} {found['with'].strip()} ".replace("  ", " ")
    return f"{verb}the left {limb}{often}, then {verb}the right {limb}{often}"


def _one_then_other(found: re.Match[str]) -> str:
    verb, limb = found["verb"], found["limb"] or ("hand" if found["verb"].startswith("punch") else "leg")
    how = "the" if verb.startswith(("rais", "lift")) else "on the" if verb.startswith("hop") else "with the"
    return f"{verb} {how} {found['one']} {limb}, then {verb} {how} {found['other']} {limb}"


def _one_and_the_other(found: re.Match[str]) -> str:
    doing, limb, more = f"{found['verb']} {found['how']}", found["limb"], found["more"]
    return f"{doing}the left {limb}{more}, then {doing}the right {limb}{more}"


def _whole_turns(found: re.Match[str]) -> str:
    return f"turns {360 * _TURNS.index(found['times'].lower())} degrees"


def _turns_around(found: re.Match[str]) -> str:
    return "turns around" + (f" to the {found['side']}" if found["side"] else "") + found["then"]


def _starts_with(found: re.Match[str]) -> str:
    return f"takes {found['steps']} starting with the {found['side']} foot"


def _limb_after_limb(found: re.Match[str]) -> str:
    verb, limb = found["verb"], found["limb"]
    one = f"{verb} " if verb.startswith(("rais", "lift")) else f"{verb} with "
    return f"{one}the left {limb}, then {one}the right {limb}"


def _faces_the_radar(found: re.Match[str]) -> str:
    """Ahead of the picture is where the radar is; who sits or kneels would get up to turn."""
    is_low = re.search(
        r"(?i)\b(?:sit|sat|seat|kneel|knelt|l[iy]|la[iy]|crouch|squat)[a-z]*\b", found.string[: found.start()]
    )
    return found[0] if is_low else "turns to face the radar"


def _on_the_way(found: re.Match[str]) -> str:
    return f"{found[1]} while {found['verb']}{'n' * (found['verb'] == 'run')}ing"


def _from_a_t_pose(found: re.Match[str]) -> str:
    """Whoever starts or comes from it, or stands in it and then does something, lowers the arms."""
    starts, then = found["starts"], found["then"]
    if not re.match("(?i)from|(?:is |are )?(?:start|begin|go|mov|com)", found[0]) and not re.search(
        "then|before", then
    ):
        return found[0]
    return f"{starts}in a t-pose, lowers them, then "


_TURNS = ["", "", "two", "three", "four", "five"]

# Replaced in this order.
_REWORDINGS: tuple[tuple[str, str | Callable[[re.Match[str]], str]], ...] = (
    (r"\b(?:over and over(?: again)?|again and again|time and (?:time )?again)\b", "repeatedly"),
    (r"\ba couple (?:of )?(?=(?:(?:more|small|big|quick|slow|short|long|little) )?(?:seconds|minutes|times|steps|strides|paces|punches|kicks|hops|jumps|squats)\b)", "two "),
    (r"\b(?<!\bas )(?<!\bis )(?<!\bthis )([a-z]{2,}(?:s|ing|ed)(?: (?:up|down|out|off|over))?) a couple (?:of )?(?!people\b|(?:[a-z]+ )?(?:friends|persons|dancers|guys|girls|boys|kids|others)\b)(?=(?:[a-z-]+ )?[a-z-]+s\b)", r"\1 two "),
    (r"\bwhile (?:still )?standing (?:still|upright|in place)(?=$|[,.])", "while standing"),
    (r"\b(crawl(?:s|ing)?(?: [a-z]+){0,2}?) on (?:(?:his|her|their|the|both) )*(?:hands and (?:knees|feet)|knees and hands|all fours)\b", r"\1"),
    (r"\bstill,? like an? (?:statue|stone|rock|log|tree)\b", "still"),
    (r"(?<!\bof )(?<!\bafter )(?<!\bduring )(?<!\bin )(?<!\bwith )(?<!\bfor )(?<!\bbetween )(?<!\bto )\bthe (?=(?:goes|walks|runs|sits|stands|comes|picks|bends|raises|lowers)\b)", "then "),
    # speed
    (r"\bspeed[- ]walk(s|ing|ed)?\b", r"walk\1 quickly"),
    (r"\bat pace\b(?! with\b)", "quickly"),
    (r"\b((?:back|for)wards?|back|left|right) at an? (?:very |rather |quite )?(?:(?P<slow>slow)|fast|quick|brisk) (?:pace|speed)\b", lambda found: f"{found[1]} {'slowly' if found['slow'] else 'quickly'}"),
    (r"\b(pick(?:s|ing|ed)? up) in (?=(?:speed|pace)\b)", r"\1 "),
    # one movement with what another clause says of it
    (r"\b(?:is|are) still(?=,? (?:and |then )*(?:then|walks|does|steps|jumps|turns|takes|runs|raises)\b)", "stands still"),
    (r"\b((?:does|performs|makes|takes) )to (?=(?:[a-z]+ ){0,2}?(?:jumps|hops|kicks|squats|steps|lunges|punches|turns)\b)", r"\1two "),
    (r"\bma(?:kes|king) an? u[- ]?turn(?: (?:on|to) (?:the|his|her|their) (?P<side>left|right)(?: side)?)?(?P<then>(?:,| and| then)+ (?:goes|walks|comes|returns|runs|jogs|heads|moves) back)\b", _turns_around),
    (r"\b(limping(?: (?!and\b|then\b|before\b)[a-z]+){0,5}?),?(?: and| while) (?:going|walking|moving)(?: around)? in an? circle\b", r"\1 in a circle"),
    (r"\b(limps) and goes(?: around)? in an? circle\b", r"\1 in a circle"),
    (r"\b(?:starts|begins) (?:walking|to walk) with (?:the|his|her|their) (?P<side>left|right) foot(?: first)?,? and (?:then )?takes (?P<steps>[a-z]+ steps(?: (?:forwards?|backwards?))?)", _starts_with),
    (r"(?<=[a-z]) until (?:he|she|they|it) (?:reach(?:es)?|gets? to|arrives? at) (?=(?:the|an?) (?:table|chair|wall|door|bed|couch|sofa|window|shelf|desk|radar)\b)", " to "),
    # ways
    (r"(?<!the )(?<!turns )(?<!turn )(?<!turning )(?<!his )(?<!her )(?<!their )\bright (?=(?:across|through|past|up to)\b)", ""),
    (rf"\b({_GAIT}) straight back(?:wards?)?{_ENDS}", r"\1 back"),
    (rf"\b(turns?|turning) {_TO}(left|right) to turn around\b", r"\1 around to the \2"),
    (rf"\bforwards?,? (?:and |but )?{_SLIGHTLY} (?:to|towards) {_OWN}?(left|right)\b", r"in a slight curve to the \1"),
    (rf"\b((?:walk|run|jog)(?:s|ing|ning|ging)?(?: [a-z]+ly)?) {_SLIGHTLY} (?:(?:to|towards) {_OWN}?)?(left|right)\b(?! (?:hand|foot|leg))", r"\1 in a slight curve to the \2"),
    (r"\b(?:walk|mov|go|step)(?:s|es|(?P<ending>ing))?(?P<way>(?: [a-z]+){0,3}?) with an? (?:(?:slight|heavy|bad|pronounced|visible|little|strong) )*limp\b(?: (?:on|in|with|of) (?:the|his|her|their) (?P<side>left|right) (?:leg|foot|side))?", _limps),
    (r"\b(?:walk|stroll|mov|go)(?P<ending>s|es|ing)?\b(?P<way>[^.;]*?),? (?:(?:and|while|who|that) )?(?:(?:as (?:if|though)|like)(?: (?:he|she|they|it))? ?)?(?:(?:seem|look|appear|act|is|are|was|were)(?:s|ing)?(?: to be| like)? )?(?:an? )?(?:very )?drunk(?:en)?(?: person| man| woman| guy)?(?= *(?:$|[.,;]| and\b| then\b))", lambda found: f"stagger{'ing' if found['ending'] == 'ing' else 's'}{found['way']}"),
    (rf"\b(?:let(?:s|ting)?|allow(?:s|ing)?) (?:them|{_OWN}?(?:both )?(?:arms|hands)) (?:to )?(?:fall|drop|go|hang|sink)\b(?! straight)(?: (?:down|back))*(?: (?:to|by|at) (?:{_OWN}|both )?sides?)?", "lowers them"),
    (rf"\bun(?:fold|cross)(?:s|es|ing)? (?:them|{_OWN}?arms)\b", "lowers the arms"),
    (r"\b(lean(?:s|ing)?) (quickly|slowly|slightly|carefully|far) (back(?:wards?)?|forwards?|to the (?:left|right))\b", r"\1 \3 \2"),
    (rf"\b(walk|jog|runn)ing and turning (?:slightly )?{_TO}(left|right)\b", r"\1ing in a curve to the \2"),
    (r"\bspin(?:s|ning)?(?: around)?(?=(?:,| and| then)+ (?:walk|run|jog|go|step)(?:s|es) back\b(?! ?wards))", "turns around"),
    (r"\bin (?:the shape of an? s|an? s[- ]?(?:shaped? )?(?:pattern|motion|line|path|way|curve|shape))\b", "in a 90 degree curve to the left, then walks in a 90 degree curve to the right"),
    (r"\b(?:appears?|seems?) to be (?=[a-z]+ing\b)", "is "),
    (r"\bside ways\b", "sideways"),
    (r"\bfrom (one )?(?:point|spot) to (point|spot|another|the next)\b(?: (?:point|spot))?", lambda found: "from one place to another" if found[1] else "from place to place"),
    (r"\b(reach(?:es|ing)?)((?: (?!up\b)[a-z]+){0,4}?) (?:into|towards?|for) the (?:air|sky|ceiling)\b", r"\1 up\2"),
    # one step, one way, the other way
    (r"\bsteps (one|two|three|four|five|six|\d) (back(?:wards?)?|forwards?|to the (?:left|right|side))\b(?! steps?)", r"takes \1 step \2"),
    (r"\b(takes|took|taking|makes|making) step\b(?! (?:by|after|like)\b)", r"\1 a step"),
    (r"\b((?:takes?|taking|makes?|making) (?:an?|one) (?:[a-z]+ )??)stride\b", r"\1step"),
    (r"\b(in|on|along|around) (an? (?:[a-z]+ )?)arch\b(?! of\b)", r"\1 \2arc"),
    (rf"\b(to {_OWN}(?:left|right)(?:,| and| then)+ )(?={_OWN}(?:left|right)(?= *(?:$|[.,;]| and\b| then\b| before\b)))", r"\1to "),
    (r"\bback (?=(?:to )?where (?:he|she|it|they) (?:was|were|started|began|came from|stood))", "back to "),
    (r"\bto to\b", "to"),
    (r"\b((?:an?|one) (?:[a-z]+ )?step((?: (?:back|forward)(?:wards?|s)?| to the (?:left|right|side)|))(?:,| and| then)+ )another(?= *(?:$|[.,;]| and\b| then\b))", r"\1one step\2"),
    (r"\banother (?=(?:[a-z]+ )?step\b)", "one "),
    (r"\bafter *, *", "then "),
    (r"\b(and|,) then after (?=(?!this\b|that\b|which\b|his\b|its\b)[a-z]+s\b(?! *,))", r"\1 then "),
    (rf"\b(and|,) after (?={_ONWARD}\b(?! *,)(?![^.;]*,? (?:he|she|they|it|the person) ))", r"\1 then "),
    (r",? after(?= *(?:[.;]|$))", ""),
    (r"\bweav(?:es|ing)\b(?! (?:an?|the|his|her|some)\b)(?: (?:in and out|left and right|right and left|back and forth|(?:from )?side to side))?", "walks in a zigzag"),
    # limbs
    (r"\b((?:turn|tilt|rotat|roll|mov|twist)(?:s|es|ing)) (?=(?:head|upper body|torso|neck)\b)", r"\1 the "),
    (r"\b(?:two|2) (kick|punch)e?s,? one with each (leg|foot|hand|arm|fist)\b", r"one \1 with the left \2, then one \1 with the right \2"),
    (r"\b(left|right) (?:hand and (?=arm\b)|arm and (?=hand\b))(?=[a-z]+(?: to\b| *(?:$|[.,;])))", r"\1 "),
    (r"\b(arms|hands) straight out (?=to )", r"\1 out "),
    (rf"\bwith (?:{_OWN}|both )*(arms|hands) (?:(?:stretched|held|extended|reaching|outstretched|straight|out|up) )+(?:in front(?: of (?:him|her|them|it|the body|his body|her body)(?:self|selves)?)?|ahead)(?= *(?:$|[.,;]| and\b| then\b| like\b| as\b| while\b))", r"with \1 held forward"),
    (rf"\b(hold(?:s|ing)?|stretch(?:es|ing)?|extend(?:s|ing)?) ((?:{_OWN}|both )*(?:arms|hands)) out (?:straight )?(?:in front(?: of (?:him|her|them|it)(?:self|selves)?)?|ahead|forwards?)\b", r"\1 \2 forward"),
    (r"\b((?:spin|rotat|swirl|circl|twirl|roll|swing)(?:s|es|ning|ing)) (?=(?:arms|hands|shoulders|wrists)\b)", r"\1 the "),
    (rf"\b({_OWN}(?:both |two )?(?:arms|hands)\b(?! of)[^.;]{{0,60}}? )((?:wav|flap)(?:s|es|ing|ping)) them\b", r"\1\2 both arms"),
    (r"\bthrow(s|ing) ((?:up )?(?:(?:his|her|their|the|both|one) )*(?:left |right )?(?:hands?|arms?)) (?:up )?(?:in|into) the air\b", lambda found: f"rais{'es' if found[1] == 's' else 'ing'} {found[2]}"),
    (r"\b(?P<verb>(?:rais|lift|wav|kick|touch|punch|stretch|stomp|swing|shak|tap)(?:s|es|ing)(?: (?!and\b|then\b|with\b)[a-z]+){0,2}?)(?: with)? one (?P<limb>hand|arm|leg|foot|knee) after (?:another|the other)\b", _limb_after_limb),
    # what is done on the way
    (r"\b((?:bounc|dribbl)(?:es|ing) (?:an?|the|his|her|their) (?:basket)?ball),? and (?!then\b)(?P<verb>walk|jog|mov|run)(?:s|es|n?ing)\b", _on_the_way),
    # arms that are held during a walk, or only where somebody starts
    (rf"\b(?:(?:is|are) )?standing in (?={_T_POSE})", "stands in "),
    (rf"\b({_WALK_ALONE}),? and (?:is |are )?(?:(?:hold|keep)(?:s|ing)|has|have|having) (?=(?:{_OWN}|both )*(?:arms|hands)\b(?: (?:on|at) |[a-z ]*\b(?:crossed|folded)))", r"\1 with "),
    (rf"\b({_WALK_ALONE}),? and (?:is |are )?(?:(?:hold|keep)(?:s|ing)|has|have|having) (?=(?:{_OWN}|both )*(?:arms|hands)\b)", r"\1 while holding "),
    (rf"\b({_WALK_ALONE}),? (?:with|while (?:holding|keeping|having)) ((?:{_OWN}|both |left |right )*(?:arms?|hands?)) (?:(?:raised|lifted|held|stretched|extended|straight)(?: (?:up(?:wards?)?|high|overhead|in the air|(?:above|over) {_OWN}head))+|(?:up(?:wards?)? )?(?:high|overhead|in the air|(?:above|over) {_OWN}head)|(?<=arms )(?:raised|lifted|up)(?! (?:to|at|sideways|forward|ahead|in front)\b))\b", r"\1 while raise_and_hold \2"),
    (rf"\b(?:(?:is |are )?(?:start|begin|go|mov|com|stand)(?:s|es|ing|ning|e)? )?(?:off |out )?(?:in|from|with|at) {_T_POSE}(?: and| then|,)* (?:lower|drop)(?:s|ing) (?:them|(?:{_OWN}|both )*(?:arms|hands)\b)", "in a t-pose, lowers them"),
    (rf"\b(?P<starts>(?:(?:is |are )?(?:start|begin|go|mov|com|stand)(?:s|es|ing|ning|e)? (?:off |out )?)?)(?:in|from|with|at) {_T_POSE}(?P<then>(?: (?:and|then|before|to)\b|,)*) (?=[a-z])", _from_a_t_pose),
    (r"\bstruggles to (?=(?:get|stand|rise|walk|sit|lift|raise)\b)", "tries to "), (r"\bstruggling to (?=(?:get|stand|rise|walk|sit|lift|raise)\b)", "trying to "),
    # pauses
    (rf"(^|[.;,]|\b(?:and|then|but)) *(?:,? then )?after {_A_SHORT}(?:pause|break|rest|moment)\b(?: of rest)?,?(?= *[a-z])", r"\1 pauses, then"),
    (rf"\b(?:takes|makes|has) {_A_SHORT}(?:pause|break|rest)\b(?! of)", "pauses"),
    # postures
    (r"\bon all four\b", "on all fours"),
    (rf"\b{_DOWN}{_ADVERBS}(?: down)? (?:on|onto|to|in|into) {_OWN}?(?:hands and knees|knees and hands|all fours)(?:,| and| then)+ (?:starts? (?:to )?)?(?:walk|mov|go|crawl)(?:s|es|ing)?\b", "kneels down, then crawls"),
    (rf"\b{_DOWN}{_ADVERBS}(?: down)? (?:on|onto|to) (?:the )?(?:floor|ground)(?:,| and| then)+ (?:starts? (?:to )?)?crawl(?:s|ing)?\b", "kneels down, then crawls"),
    (r"\b(kneel(?:s|ing|ed)?|knelt)(?: down)?(?: (?:on|onto|to|with))? (?:one|a single) knee\b", r"\1 one_knee"),
    (r"\b(?:is|are) (?:down )?on (?:one|a single) knee\b", "is kneeling one_knee"),
    (rf"\b{_DOWN}{_ADVERBS}(?: down)?{_ADVERBS} (?:on|onto|to) (?:one|a|a single) knee\b", "kneels down one_knee"),
    (rf"\b{_DOWN}{_ADVERBS}(?: down)?{_ADVERBS} (?:on|onto|to) (?:the|his|her|their) (left|right) knee\b", r"kneels on the \1 knee"),
    (r"\b(?:stays?|remains?|holds?|keeps?|staying|remaining|holding)(?: (?:down )?in)? (?:an? |the )?(?:deep |low |half )?(?:squat|crouch)(?:ing|ed)?(?: (?:position|pose|posture|stance))?\b", "crouches"),
    (r"\b(?:gets?|getting|drops?|dropping)(?: down)? into an? (?:deep |low )?(?:squat|crouch)(?:ing)?(?: (?:position|pose|posture|stance))?\b", "squats"),
    (r"\b(?:gets?|stands?|rises?|comes?|getting|standing|rising|coming)(?: back)? up from an? (?:squat|crouch)(?:ing|ed)?(?: (?:position|pose|posture|stance))?\b", "crouches, then stands up"),
    (r"\b((?:squat|crouch|bend|lean)(?:s|es|ing|ting)?\b[^.;]{0,40}?(?:,| and| then)+) (?:stay|remain|hold|keep|wait|paus|freez)(?:s|es|ing|e)?(?: (?:still|it|there|low|down|bent|crouched|put|so|bent over|like that|like this|(?:in )?(?:(?:the|that|this) )?(?:position|posture|pose|squat|stretch|crouch|bend)))+(?=$|[,.;]| and\b| then\b| before\b| for\b)", r"\1 stays"),
    (r"\b(?!stand|end|finish|start|begin|keep|try|is\b|are\b|was\b|th[ei]s\b|always\b|legs\b|arms\b|knees\b|hands\b|his\b)([a-z]+(?:s|ing)\b(?: (?!and\b|then\b|before\b|after\b|while\b|from\b|by\b|as\b|is\b|are\b|keeps\b|starts\b|begins\b)[a-z]+){0,5}?) (?:while )?standing up(?= *(?:$|[.,;]| and\b| then\b))", r"\1 while standing"),
    (r"\b((?:rais|lift)(?:es|s|ing) [^,.;]{0,20}?(?:leg|knee|foot|arm)\b[^.;]{0,20}?(?:,| and| then)+) (?:stay|remain|hold|keep)(?:s|es|ing)? (?:still|it there|there|so|like that|like this|(?:in )?(?:the|that|this) (?:position|posture|pose))(?=$|[,.;]| and\b| then\b| before\b| for\b)", r"\1 stays"),
    # whole turns
    (r"\b(?:mak|do|perform|tak|complet|execut)(?:es|s|ing)? (?P<times>two|three|four|five) (?:full|complete|whole|360[- ]degrees?) (?:turns|spins|rotations)\b", _whole_turns),
    (r"\b(turn|spin|rotat)(s|es|ing|ning)?(?: around)? (?P<times>two|three|four|five) (?:full|complete|whole) (?:turns|circles|times|rotations)\b", _whole_turns),
    (r"\b(?:an? |one )?(?:full |whole |complete )?(?:circle|turn|rotation)s? and a half\b|\bone and a half (?:turns|circles|rotations)\b", "540 degrees"),
    (r"\b(?P<verb>[a-z]+(?:s|ing)) (?P<how>(?:up )?(?:with |on )?)(?:one|a) (?P<limb>arm|hand|leg|foot|knee|fist)(?P<more>(?: (?!and|then)[a-z]+){0,3}?)(?:,| and| then)+ (?:with |on )?the other(?: (?P=limb)| one)?(?=$|[,.;]| and\b| then\b)", _one_and_the_other),
    (rf"\bwith (?:{_OWN}|both )*(arms|hands) (?:held )?out\b(?: (?:for balance|for stability|(?:to|at|from) (?:{_OWN}|both )?sides?|wide|sideways))*(?! (?:in|ahead|forwards?|straight|of|like|as)\b)", r"with \1 held out to the sides"),
    (r"\b(wav(?:es|ing)(?: [a-z]+){0,3}? (?:hands?|arms?)) in the air\b", r"\1"),
    # the trunk, and a step that is climbed
    (rf"\b(?:(?:turn|rotat|swivel|twist|pivot)(?:s|es|ing) and )?(?:turn|rotat|swivel|twist|pivot)(?P<ending>e?s|ing)(?P<way> (?:to (?:{_OWN})?)?(?:left|right)(?: and (?:to (?:{_OWN})?)?(?:left|right))?)? (?:at|from|in) {_OWN}?(?:waist|hips?|torso)\b", lambda found: f"twist{'ing' if found['ending'] == 'ing' else 's'} the upper body{found['way'] or ''}"),
    (r"\bclimb(s|ing)(?: up| onto| on)? (?:an?|one|the) (?:(?:single|small|large|big|high|low) )?step\b", r"walk\1 up a step"),
    (rf"\b(?:turns?(?: (?:around|back|again))? to (?:be )?fac(?:e|ing)|faces) (?:straight |back )?(?:to )?(?:the )?(?:forwards?|front|ahead)(?: again)?{_ENDS}", _faces_the_radar),
    # each leg in turn
    (r"\b(?P<verb>(?:rais|lift|kick|stomp|stamp|wav)(?:es|s|ing|ping))(?P<with>(?: with| on)?) (?:the|his|her|their|both) (?P<limb>legs|feet|knees|arms|hands)(?: up)? (?:in turns?|one after the other|one at a time|alternately|alternatingly)(?P<often>)", _left_then_right),
    (r"(?<!while )\b(?P<verb>st[ao]mp(?:s|ing)) (?P<with>)(?:the|his|her|their|both) (?P<limb>feet)(?P<often> twice| once| (?:two|three|four|five|\d+) times)?(?= *(?:$|[.,;]| and\b| then\b))", _left_then_right),
    (rf"\b(?P<verb>(?:rais|lift|wav|kick|stomp|stamp|swing|stretch)(?:es|s|ing|ping))(?P<with>(?: with| on)?) {_OWN}?left(?: (?:leg|foot|knee|arm|hand))? and (?:with |on )?{_OWN}?right (?P<limb>leg|foot|knee|arm|hand)s?(?P<often> twice| once| (?:two|three|four|five|\d+) times) each\b", _left_then_right),
    (r"\b(?P<verb>(?:kick|stomp|stamp|hop|punch)(?:s|es|ing|ping))(?: (?:alternately|alternatingly|in turn))? (?:with |on )?(?:(?:the|his|her|their) )?(?P<one>left|right)(?: (?:leg|foot|hand|arm|fist))? and (?:(?:the|his|her|their) )?(?P<other>left|right)(?: (?P<limb>leg|foot|hand|arm|fist))?(?: (?:alternately|alternatingly|in turn))?(?=$|[,.;]| and\b| then\b)", _one_then_other),
    (r"\b(?P<verb>(?:rais|lift)(?:es|s|ing)) (?:(?:the|his|her|their) )?(?P<one>left|right) (?:leg|knee|foot) and (?:(?:the|his|her|their) )?(?P<other>left|right) (?P<limb>leg|knee|foot)(?: (?:alternately|alternatingly|in turn))?\b", _one_then_other),
    (r"\b(?P<verb>(?:rais|lift)(?:es|s|ing)) (?P<with>)(?:each|both|alternating|(?:his|her|their|the) alternate) (?:of (?:his|her|their) )?(?:(?:his|her|their) )?(?P<limb>legs?|feet|foot|knees?)\b(?: (?:up|alternately|alternatingly|in turn|one after the other|one at a time))*(?P<often> twice| once| (?:two|three|four|five|\d+) times)?", _left_then_right),
    (r"\b(?P<verb>(?:kick|stomp|stamp|hop)(?:s|ing|ping)) (?P<with>with |on )(?:each|both|alternating|alternate) (?P<limb>legs|feet) (?:alternately|alternatingly|in turn|one after the other|one at a time)(?P<often>)", _left_then_right),
    (r"\b(?P<verb>(?:kick|stomp|stamp|hop)(?:s|ing|ping)) (?P<with>with |on )(?:each|alternating|alternate) (?P<limb>legs?|foot|feet)(?P<often> twice| once| (?:two|three|four|five|\d+) times)?\b", _left_then_right),
    (rf"\btwist(s|ing) (?:to )?{_OWN}?(?:left and (?:then )?(?:to )?{_OWN}?right|right and (?:then )?(?:to )?{_OWN}?left)\b", r"twist\1 the upper body"),
)  # fmt: skip
_COMPILED = [(re.compile(pattern, re.IGNORECASE), replacement) for pattern, replacement in _REWORDINGS]


def reworded(text: str) -> str:
    """The sentence with words put otherwise that mean something else alone; itself where there are none.

    >>> reworded("a person walks forward with a limp on the right leg")
    'a person limps forward with the right leg'
    """
    for pattern, replacement in _COMPILED:
        text = pattern.sub(replacement, text)
    return text
