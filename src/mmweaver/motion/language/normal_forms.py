"""Other ways to say what the grammar knows, tried where a sentence is not understood as it is."""

import re
from collections.abc import Callable

_OWN = r"(?:(?:his|her|its|their|the|both|a|an|one|my) )*"
_SIDE = r"(?:left|right)"
_CLOCK = r"(?:(?:counter|anti)[- ]?)?clock[- ]?wise"
_WALK = r"(?:walks?|walking|goes|going|runs?|running|moves?|moving|jogs?|jogging)"
_HOLDING = r"drinks?|drinking|eats?|eating|reads?|reading|waves?|waving|claps?|clapping|types?|typing|writes?|phones?"
_MOTION = r"(?:motions?|movements?|gestures?|moves?|exercises?)"

NORMAL_FORMS: tuple[tuple[str, str | Callable[[re.Match[str]], str]], ...] = (
    # misspelt and mistyped
    (r"\bper(?:so|o|os)ns? (?=walks|is|goes|turns|jumps|does|makes|runs)", "person "), (r"\bperons?\b", "person"),
    (r"\bsomone\b|\bsome ?one ?who\b", "someone"), (r"\brigth\b|\brihgt\b", "right"), (r"\beft\b", "left"), (r"\b(?:a|the) humans\b", "a human"),
    (r"\b([a-z]{3,})ig\b", r"\1ing"),
    (r"\bagains?g?t?(?: the)? clock-?wise(?: direction)?\b", "counterclockwise"), (r"\bto to\b", "to"),
    (r"\s*\((?:\s*[a-z?, ]+\s*)\)", ""), (r"[/|]", " or "), (r"\b([a-z]+) or [a-z]+(?= (?:movement|motion|is empty|with))", r"\1"), (r" instead(?= *(?:$|[.,]))", ""),
    (r"\b(?:pretends|seems?|appears?|try|tries|trying) to (?:start |begin )?(?=[a-z])", ""), (r"\blooks? like (?=playing|dancing|waving|walking)", "is "), (r"\b(?:,? )?during (?:that|this|which)(?=,| | the)", " while"),
    (r"\b(?:a motion|motions?|movements?|moves|an action)(?: a bit)? (?:like|which resembles|that resembles|similar to|as if|resembling) (?=[a-z]+ing)", ""), (r"\b(?:is )?(?:mak|perform|do)(?:es|s|ing)? (?=(?:play|throw|kick|punch|wav|wip|stirr|hitt|bounc|swimm|danc|walk|runn|jump|driv)ing)", "is "),
    (r"\b(?:mak|perform|do)(?:es|s|ing)? (?:an? |some |one )?(?:[a-z]+ )?(kick|punch|throw|wave|stir|jump|bow|squat|knock)(?:p?ing)? (?:motion|movement|gesture|move)s?\b(?: like [a-z ]+?(?=$|[,.]| and))?", r"\1s"),
    (r"\b(?:is )?(?:mak|perform|do)(?:es|s|ing)? (?:an? )?(?:little|small|big|high|short|quick|stretched|nice)? ?jump (?:in the air|mid-?air|up(?:wards?)?)\b|\b(jump(?:s|ing)?) (?:straight )?(?:(?:\d+|about \d+) ?(?:cm|centimeters?) )?(?:up(?:wards?)|in the air)(?= *(?:$|[.,]|and|then|with))", "jumps"),
    (r"\b(?:use|using|uses) (?:his|her|its|their|the) (left|right|both) (hands?|arms?|foot|leg) to (toss|hit|pick|wipe|push|pull|throw|grab|wave|clean|kick|punch|stir|reach|knock|drink|write|bang)\b", r"with the \1 \2 \3s"),
    (r"\b(?:does|do|performs?|makes|making|doing) (?:an? )?(\d+)[- ]?degrees? twist\b", r"turns \1 degrees"), (r"\ban? (\d+) (clockwise|counter-?clockwise) jump\b", r"\1 degree \2 jump"),
    (r"(?:,? and|,? then|,)? returns(?= *(?:$|[.,]))", ", then walks back"), (r"\bwalks sideways back(?: to [a-z ]+)?\b", "sidesteps"), (r"\bsidestep(?:s|ping) back to [a-z ]+?(?=$|[,.])", "sidesteps"),
    (r"\bdue to (?:an? )?(?:strong |hard |light |slight )?(?:push|shove|hit)(?: forwards?| backwards?)?\b", "because he is pushed"), (r"\b(?:steps?|lunges?|moves?)( fast| quickly| backwards)? to the (left|right)(?:,? as if he was pushed| because he is pushed)", r"is pushed to the \2"),
    (r"\bgets? (?:slightly )?(?:off|out of) balance\b", "stumbles"), (r"\bmakes an? (?:break|pause|stop)\b", "stops"), (r"\b(?:rises|rise|rising) (?=and lowers)", "raises "), (r"\b(raises|lifts) and (?:then )?lowers\b", r"\1"),
    (r"\bwalks (?:up|down )?(?:(?:\d+|two|three|four|five|a few|some) )?steps (?:up|down) (?:an? |the )?stairs?\b", "step_up_and_down"), (r"\b(?:counter|anti)?-?clockwise small circle\b", lambda found: "small circle " + found[0].split()[0]), (r"\bmoves? (anti-?clockwise|counter-?clockwise|clockwise) in a circle\b", r"walks in a circle \1"),
    (r"\bsubject (?=in )", "person walks "), (r"\bmoves? (quickly|slowly|fast)(?= and| *[,.])", r"walks \1"), (r"\bmoves? (?:in|along) (?=an? (?:\w+ )?(?:quarter|half|edge|circle))", "walks in "), (r"\bmoves along\b", "walks along"),
    (r"\b(?:is )?getting down on\b|\bgets? on(?=(?: \w+)? (?:all|knees|his|her))", "goes down on"), (r"\bsit(?:s|ting)(?: down)? in a kneeling position\b", "kneels down"), (r"\b(?:is )?sitting on his knees is\b", "kneeling"),
    (r"\bhops? (\d+|two|three|four|five) times on the (left|right) leg forwards?\b", r"hops on the \2 leg \1 times"), (r"\b(jump(?:s|ing)? sidewards|jumps sideways)(?: (?:several|\d+|two|three) times)? to the left and right\b", "jumps to the left, then jumps to the right"),
    (r"\bwalk(s|ing) in(?: a)? bend(?:ing)?(?: motion)?\b", r"walk\1 in a curve"), (r"\b(?:in|with) right angles\b", "by 90 degrees"), (r"\bforwards and (right|left)wards?\b", "forwards"),
    (r"\bthen (?:walks )?(\d+) (?:more|steps more)\b", r"then walks \1 steps"), (r"\b(\w+) slow and (\w+) fast steps\b", r"\1 slow step, then \2 fast steps"),
    (r"\bassumes? an upright (?:posture|stance|position)(?: after(?:wards?)?)?\b", "stands up"),
    (r"(?:,? (?:and|before|then))* (?:returns?|goes back|gets? back|get back|recovers?) (?:in|into|to) (?:(?:the|his|her|its) )?(?:(?:previous|original|initial|old|former|starting) )?(?:position|place|spot)\b(?= *(?:$|[.,]))", ", then walks back"),
    (r",? (?:in order |so as )?(?:not )?to (?:avoid|prevent|not|keep from|maintain|stay) [^,.;]*?(?=$|[,.;]| and\b| then\b)|,? so (?:that )?(?:it|he|she) (?:does|do|did) ?(?:not|n't) [^,.;]*", ""),
    (r"\b\d+ (strokes?|tones?|notes?) on (?=(?:an? |the )?(?:guitar|violin))", r"\1 on "), (r"\b(guitar|violine?) (?:moves?|motions?)\b", r"\1 playing"),
    (r"\bviolin[ae]\b", "violin"), (r"\binstuments?\b", "instrument"),
    (r"\bcatch(?:es|ing) (?:his|her|its) steps?\b", "recovers"),
    (r"\bcom(?:es|ing) (?:very |really |quite )?(?:close|near) to the (?=observer|camera|radar|viewer)", "walks towards the "),
    (r"\bstreched\b", "stretched"), (r"\bzwo\b", "two"), (r"\bstreight\b", "straight"), (r"\bforwads?\b", "forwards"),
    (r"(?:,? and|,| before|,? then) returning(?: to [a-z ]+?)?(?=$|[.,])", ", then walks back"), (r"\bcurv(?:es|ing) (?=to the)", "walks in a curve "),
    (r"\b(?:moves?|goes) (?:laterally|lateral)\b|\blateral (?:moves?|steps?|movements?)\b", "sidesteps"), (r"\brais(?:es|ing) up(?=$|[.,])", "stands up"), (r"\b(?:athlete?|dancer|runner|walker|boxer|fighter)\b", "person"),
    (r"\bwa(?:k|kl|lki?)ing\b", "walking"), (r"\btunes (?=left|right)", "turns "), (r"\bboth feed\b", "both feet"),
    (r"\b(takes?|makes?|does|doing|performs?|another) to (?=(?:big |small |large )?steps?\b)", r"\1 two "),
    (r"\bcontinuous(?:ly)? to (?=walk|run|go)", "continues to "), (r"\bbaske?t? ?ball?\b", "basketball"),
    (r"\b(?:cirle|circel|cricle)(s?)\b", r"circle\1"), (r"\bquter\b", "quarter"), (r"\bpuched\b|\bstoved\b", "pushed"),
    (r"\bguitar(?:re|e)\b", "guitar"), (r"\bviolette\b", "violin"),
    (r"\bkneeing\b", "kneeling"), (r"\bwavs\b", "waves"), (r"\b(?:wals|wallks)\b", "walks"),
    (r"\b(?:cautious|careful|sluggish|tiny|normal|hesitant|firm|relatively|very|quick|fast) (?=(?:cautious |forward )?steps?\b)", ""),
    (r"\bforward steps\b", "steps forwards"), (r"\ba large and a small step\b", "two steps"),
    (r"\bshak(es|ing) (?:(?:his|her|its|their|the) )?head no\b", r"shak\1 the head"), (r"\b(nods|nodding) yes\b", r"\1"),
    (r"\b((?:both |the |his |her |their )*arms?\b[^.;]*?\b(?:rais|lift)(?:es|s|ing)) them\b", r"\1 both arms"),
    (r"\bveer(?:s|ing|ed) (?:off |slightly )?(?:to |towards )?(?:the |his |her |their )?(left|right)\b(?: side)?", r"walks in a curve to the \1"),
    (r"\b(?:back )?the way (?:he|she|it|they) (?:came|went|walked)(?: from)?\b", "back"),
    (r"\b(?:back )?to where (?:he|she|it|they|the person) (?:(?:was|were|had been) )?(?:standing|stood|started|began|was|were|came from)(?: from| before)?\b", "back to the starting point"),
    (r"\b(?:takes?|makes?|taking|making) an? (?:sharp |slight |hard |quick |slow |abrupt )?(left|right)(?! (?:step|turn|foot|leg|hand|arm|seat|side|hook|punch|jab))", r"turns to the \1"),
    # circles
    (r"\bin (?:an? )?(quarter|half|third)(?: of)? an? (?:small |big |wide )?circle\b", r"in a \1 circle"),
    (r"\b(?:against|counter to) the clock(?:wise direction)?\b", "counterclockwise"),
    (r"\b(?:for |by )?one[- ](quarter|half) of a (?:rotation|turn|circle)\b", r"in a \1 circle"),
    (r"\bby following an? (half|quarter|full) circle(?: path)?\b", r"in a \1 circle"), (r"\bin an incomplete circle\b", "in a circle"),
    (r"\b(?:is )?(?:doing|does|walks?|walking|makes|making) an? three[- ]quarters? ((?:counter[- ]?|anti[- ]?)?clockwise) circle\b", r"walks in a three quarter circle \1"),
    (r"\bquarter (left|right) sides? circle\b", r"quarter circle to the \1"), (r"\b(?:two|three) (?:small |big )?circles\b", "in a circle"),
    # a jump with a turn, after which the person turns
    (r"\bturn(?:s|ing) (\d+) degrees? ((?:left|right)(?:wards?)? )?while jumping(?: in the air)?\b", r"jumps, then turns \1 degrees \2"),
    (r"\bturn(?:s|ing) around while jumping(?: in the air)?\b", "jumps, then turns around"),
    (r"\bjump(?:s|ing)?(?: up)? and turns? (\d+) degrees?(?: around (?:him|her|it)self)?(?: before landing| mid-?air)\b", r"jumps, then turns \1 degrees"),
    (r"\btwo[- ]legged hop\b", "jump"), (r"\bjump(s|ing)? straight up(?:wards?)?\b", r"jump\1"), (r"\bjump with both feet\b", "jump"),
    (r"\b(jump|hop) to the front\b", r"\1 forwards"),
    # on hands and knees
    (r"\b(?:rises|gets up|stands up|standing up|getting up|get up)(?: to (?:an )?upright (?:stance|posture))? from (?:being |resting |standing )?on all[- ]fours\b", "stands up from the knees"),
    (r"\b(?:on|laying on|lying on) (?:his|her|its|their) (?:hands and )?knees (?:is )?(?:stands|standing|gets|getting) up\b", "stands up from the knees"),
    (r"\bwalk(s|ing) on all[- ]fours?\b", r"crawl\1"),
    # push and balance
    (r"\b(?:regains|finds) (?:his|her|its) (?:posture|stance|way back)[a-z ]*?(?= and\b|[,.]|$)", "recovers"),
    (r"\b(?:performs?|makes?|does) an? recovery step\b(?: to the (?:left|right|front|back))?", "recovers"),
    (r"\breacts to (?:an? |the )?(?:perturbation|push|disturbance)(?: (?:during|while) walking)?\b", "walks, stumbles, then walks"),
    (r"\brecover(?:s|ing) from (?:an? |the )?(?:external |outer )?(?:force|hit|impact)\b", "stumbles"),
    (r",? (?:and|but|as) (?:it |he |she )?looks? like (?:it|he|she) (?:got|was|has been) pushed(?: before)?\b", ""),
    (r"\bwhirls? around\b", "turns 360 degrees"), (r"\bin a hurry\b", "quickly"),
    (r"\bevad(?:es|ing) to the (left|right)(?: taking a [a-z]+ step)?\b", r"sidesteps to the \1"),
    (r"\bjumping sidestep to (?:his |her |the )(left|right)\b", r"jump to the \1"),
    (r"\bdwa?dling(?: as (?:he|she) does so)?\b", "slowly"),
    # hands
    (r"\b(left|right)[- ]handed (?:boxing )?(throw|punch|jab|wave)(?:ing)?(?: motion| movement)?\b", r"\2 with the \1 hand"),
    (r"\b(?:performs?|does|makes) an? (throw|punch|jab|wave) with\b", r"\1s with"),
    (r"\b(?:strok(?:es|ing)|strik(?:es|ing)|strumm?ing) (?:the |an? )(?:air )?guitar\b|\bstrikes on an? (?:air )?guitar\b", "plays the guitar"),
    (r"\b(plays?|playing) (?:the |a )(violin|guitar),? (?:while |by )?(?:he |she |it )?(?:is )?(?:hold(?:s|ing)) it [a-z ]*?(?:and|,) (?:playing|plays|stroking|strokes) ?[a-z ]*", r"plays the \2"),
    (r"\bas if playing (?:the |a )(violin|guitar)(?: that he is holding [a-z ]+|, holding it [a-z ]+)?", r"plays the \1"),
    (r"\b(?:performs?|makes?|does) (?:a |an |some )?(?:arm )?(?:motions?|movements?|moves?) (?:a bit )?(?:like )?(?=plays? (?:the )?(?:violin|guitar))", ""),
    (r"\b(?:shakes|shaking) an(?:other|others) person(?:'?s)? hand(?: with (?:his|her|its) (?:left|right) hand)?\b", "shakes hands"),
    (r"\bdraws (?:an? |two |three |some )?(?:imaginary )?(?:horizontal|vertical) lines? with (?:both|the|his|her)[a-z -]*", "writes on a board"),
    # the same, said otherwise
    (r"\bwip(es|ing) (?:it|o?m?ething|something|(?:once )?(?:horizontal|vertical)(?:ly)?(?: once)?)\b", r"wip\1 the table"), (r",? which is [a-z ]+?(?=$|[,.])", ""),
    (r"\b(?:left and (?:the |his |her )?right|right and (?:the |his |her )?left) (arm|hand)s?\b", r"both \1s"),
    (r"\bholds? up (a|one|his|her|its|both|the) ((?:left |right )?)(hands?|arms?)\b", r"raises \1 \2\3"),
    (r"\bhold(?:s|ing) out (?:his|her|their|its|both) arms\b", "stretching both arms out to the sides"),
    (r"\b(?:while |by )?spreading (?:his|her|their|its|both|the) arms\b", "while stretching both arms out to the sides"),
    (r",? (?:with )?(?:both |his |her |the )?arms (?:are )?spread(?:ed)?(?: out)?(?: to (?:the|both) sides?)?\b", " while stretching both arms out to the sides"),
    (r"\bstoop(?:s|ing)?(?: down)?\b", "bends down"),
    (r"\bcomes? (?:close|closer|near|nearer) to (?=the (?:camera|radar|viewer))", "walks towards "),
    (r"\b(?:gets?|getting|goes|comes?|moves?|returns?|recovers?)(?: back)? (?:in|into|to|on) (?:his|her|its|their|the) "
     r"(?:(?:original|initial|old|former|previous) )?(?:position|path|track|way|course|direction)\b(?= *(?:$|[.,]))|\bmak(?:es|ing) (?:his|her|its|their) way back on track\b",
     "recovers"),
    (r"\b(?:keep|hold|get)s?(?:ing)? (?:his |her |its |their |the )?balance\b", "recovers"),
    (r"\b(?:tr(?:y|ies|ying)) to (?=recover)", ""),
    (r"\b(?:is |are )?(?:taking|takes|makes|making|does|doing) (?:an? |some |a few )?(?:few |small )*(?:correct(?:ing|ion)|compensat(?:ion|ory|ing)|recovery|balancing) steps?\b", "recovers"),
    (r"\b(?:does|makes|performs|is doing)? ?an? (?:compensatory|compensation|compensating) (?:movement|motion)\b|\b(?:does |is doing |makes )?an? push[- ]?recovery(?: step)?\b|\b(?:has|having) lost (?:his|her|its) balance\b",
     "stumbles"),
    (r"\bcompensat(?:es|ing) (?:for )?(?:the |a )?(?:disturbance|push|hit)\b", "recovers"),
    (r"\bslip(?:s|ping)?(?: away)? to (?:the|his|her) side\b", "stumbles"),
    (r"\bget(?:s|ting) shove\b", "gets shoved"),
    (r"\b(?:does|doing|practi[cs]es|practi[cs]ing|performs?) (?:some )?yoga(?::|,| with| in)? (?=(?:the |a )?(?:tree|warrior|downward|plank))", "in "),
    (r"\b((?:wakes? up|waking up)(?: and|,| then)+ )?(?:gets?|getting|climbs?|rolls?) (?:up )?out of (?:the |his |her |their )?bed\b", "is lying on the bed, then gets up"),
    (rf"\b(?:raises?|lifts?|raising|lifting) {_OWN}({_SIDE} )?(arms?|hands?)(?: up)?(?: (?:straight )?(?:above|over) (?:the|his|her|their) heads?)?(?: and|,| then)+ (?:holds?|keeps?|leaves?) (?:it|them) (?:there|up there|in the air)\b",
     r"lifts the \1 \2 straight up and keeps it up"),
    (r"\bcircuit\b", "circle"), (r"\b(circles?), (?=(?:(?:counter|anti)[- ]?)?clockwise|to (?:the|its|his) (?:left|right))", r"\1 "),
    (r",? (?:where it passes through|(?:and )?thereby describes|describing|thus describing) an? (quarter|half|full) circle(?: line)?(?: along)?\b", r" in a \1 circle"),
    (r"\b(?:is )?(?:performing|performs|doing|does|makes|making) a (left|right) (\d+)[- ]degrees? (?:curve|bend|circle)\b", r"walks in a \2 degree curve to the \1"),
    (r"\b(left|right)[- ]turn of (\d+) degrees?\b", r"\2 degree turn to the \1"),
    (r"\b(?:with|at|in) an angle of (\d+) degrees?\b", r"by \1 degrees"),
    (r"\bturns? swinging around\b|\bswings around(?! \d)", "turns around"), (r"\bswings around (?=\d)", "turns "),
    (r"\b(?:makes? |does |and then )?an? swinging (\d+) degrees? change of direction\b", r"turns \1 degrees"),
    (r"\b(?:does |is doing |makes |performs )?(?:an? )?side[- ]?jumps?\b", "jumps sideways"),
    (r"\bjumps sideways to the\b", "jumps to the"),
    (r"\b(?:mak|do|perform)(?:es|s|ing|e)? an? (?:far|long|wide|big) jump\b", "jumps forwards"),
    (r"\b(?:does|makes|performs) an? jump (?:about )?\d+ ?cm (?:straight )?(?:up|upwards)\b", "jumps"),
    (r"\b(\d+)[- ]?degrees? ?(?:(counter[- ]?clockwise|clockwise|left|right) )?(?:jump|hop)s?\b", r" jump, then turns \1 degrees \2"),
    (r"\bturn(?:s|ing) (\d+) degrees?((?: to (?:the|its|his) (?:left|right))?) (?:while jumping|during an? jump|in the air)(?: with both (?:legs|feet))?",
     r"jumps, then turns \1 degrees\2"),
    (r"\bjumps? and turns? (\d+) degrees? while in the air\b", r"jumps, then turns \1 degrees"),
    (r"\blifting and (?=stomp|stamp)|\bslow(?:s|ing) down while (?=[a-z]+ing)", ""),
    (r"\bcatch(?:es|ing)? and (?=throw)", "reaches for something, then "),
    (r"\buses? (?:his|her|its|their) (left|right|both) (hands?|arms?) to (hit|pick|wipe|push|pull|throw|grab|wave|clean)\b", r"with the \1 \2 \3s"),
    (r"\bbefore letting (?:down )?(?:his|her|its|the) (?:left |right )?(?:leg|foot)(?: down)?\b", ""),
    (r"\bstanding up while kneeling\b", "standing up from the knees"), (r"\bsit(?:s|ting) on (?:his|her|its|their) knees\b", "kneeling"),
    (r"\bresum(?:es|ing) (?:his|her|its|the) (?:motion|walk|way|movement)\b", "walks"), (r"\bis stopped by [a-z ]*?(?= and\b|[,.]|$)", "stops"),
    (r"\bplay(?:s|ing)? (?:an? |some )?(?:single )?(?:tones?|notes?|strokes?) on (?:an? |the )(guitar|violin)e?\b", r"plays the \1"),
    (r"\bplay(?:s|ing)? (?:an? |the |some )?(?:string )?instrument\b", "plays the guitar"),
    (r"\bsit(s|ting)? (down )?on (?:an? |the )?(?:low |small |high |little )*(?:platform|box|cube|step|ledge|block|rock|barrel|object|something)\b", r"sit\1 \2on a stool"),
    (r"\ba persons\b|\ban man\b", "a person"),
    (r"\b(?:tries|trying|attempts|seems|begins|wants|appears|prepar\w+) to (?:be )?(?=[a-z])", ""),
    (r"\ba couple of (?:[a-z]+ )?steps\b", "two steps"),
    (r"\b(\w+) and (?:a )?half steps\b", r"\1 steps"),
    (r"\b(\w+ )?(large|big|small|quick|short|long) and (large|big|small|quick|short|long|slow|fast) step\b", r"step"),
    (rf"\busing {_OWN}(left|right|both) (hands?|arms?|foot|leg)\b", r"with the \1 \2"),
    (r"\b(?:is |are )?(?:holding|holds) (?:a |the )?(guitar|violin)[a-z ]*?(?:and )?(?:playing|strok|plays)[a-z]*(?: it)?\b", r"plays the \1"),
    (r"\b(?:performs?|making|doing|makes?) (?:[a-z]+ ){0,3}(?:strokes?|tones?|notes?) on (?:an? |the )(guitar|violin)e?\b|\b(guitar|violin) (?:stroke|playing)s?\b",
     r"plays the \1\2"),
    (r"\bback(?:s|ing) (?:slowly )?(?:away|off|up)\b(?: from [a-z]+)?", "walks backwards"),
    (rf"\b(?:with|using) {_OWN}({_SIDE}) (?:hand|arm),?(?: (?:he|she|they))? (?:starts?|performs?|makes?|does|doing) (?:an? |some )?circular (?:motion|movement)s?\b", r"draws a circle with the \1 hand"),
    (r"\b(?:starts?|performs?|makes?|does) (?:an? )?circular movement\b(?! with| of)", "walks in a circle"),
    (r"\bbend(?:ing|ed)? (walk|walking)(?: (?:motion|movement))?\b", r"walks in a curve"),
    (r"\bgets? (?:down )?(?:to|on) (?:his|her|its|their) knees\b", "kneels down"),
    (r"\bstay(?:s|ing) on (?:both |his |her )*knees\b|\bstands? on (?:his|her) knees\b", "is kneeling"),
    (r"\ba whole turn\b", "a full turn"),
    (r"\b(?:brush|comb)(es|ing|s)? (teeth|hair)\b", r"brushes the \2"),
    (r"\b(left|right) (u-?[ ]?turn)\b", r"\2 to the \1"),
    (r"\bperfoms?\b|\bpeforms?\b", "performs"),
    (r"\bsquads?\b", "squats"),
    (r"\bwhip(es|ing)\b(?! cream)", r"wip\1"),
    (r"\btruns?\b|\btrurns\b", "turns"),
    (r"\bturing\b", "turning"),
    (r"\bcirles?\b", "circle"),
    (r"\b(left|right|forward|backward) food\b", r"\1 foot"),
    (r"\bsidewared\b", "sideways"),
    # circles and curves
    (rf"\b(?:in |along |around )?(?:an? |the )?((?:(?:small|big|large|wide|tight|full|whole|slow|complete) )*)({_CLOCK}|"
     r"left|right|leftwards?|rightwards?|left-sided|right-sided)[- ,]*(?:circles?|round)\b", r" in a \1 circle \2 "),
    (r"\b(walks?|goes|walking|runs?)((?: slowly| fast| quickly)?) an? (full|whole|complete|small|big|three quarter|quarter|half) circle\b", r"\1\2 in a \3 circle"),
    (r"\b(circle) to (?:its|his|her) (left|right)\b", r"\1 to the \2"),
    (r"\b(?:performs?|performing|makes?|making|takes?|taking|does|doing) (?:an? )?(?:tight |wide |slight )*(\d+)[- ]degrees? (left |right )?(curve|bend)\b",
     r"walks in a \1 degree \3 to the \2"),
    (rf"\b(?:a )?(?:quarter|fourth)(?: of an?)?,? ({_SIDE})(?:wards?|[- ]sided)? circle\b", r" a quarter circle to the \1 "),
    (r"\b(circle \w*-?sided)\b", r"\1"),
    (r"\b(left|right)[- ]sided\b", r"to the \1"),
    (r"\bin circles?\b(?! of)", "in a circle"),
    (r"\b(?:makes?|making|does|doing|performs?|performing|takes?|taking) (?:an? |the )?u-?[ ]?turn\b", "walks in a half circle"),
    (r"\b(?:performs?|performing|makes?|making|takes?|taking|does|doing) (?:an? )?(\d+)[- ]degrees? (curve|bend)\b",
     r"walks in a \1 degree \2"),
    (r"\b(?:performs?|performing|makes?|making|takes?|taking|does|doing) (?:an? )?(quarter|half)(?: of an?)? circle\b",
     r"walks a \1 circle"),
    (r"\b(?:in )?(?:an? |the )?(?:shape of an? )?figure[- ](?:of[- ])?(?:an? )?(?:eight|8)\b|\bin an? (?:eight|8)\b",
     "in a circle to the left, then walks in a circle to the right"),
    (r"\b(?:in |along )?(?:an? )?s[- ](?:shaped? ?(?:line|curve|path)?|curve|line)\b",
     "in a 90 degree curve to the left, then walks in a 90 degree curve to the right"),
    # turns
    (r"\bturns? (?:himself |herself |itself )?(?:all the way |completely |fully )(?:around|round)\b", "turns 360 degrees"),
    (r"\b(jump|hop)(s|ing)? (?:\w+ ){0,3}?(\d+)[- ]?degrees?(?: turn| rotation)?\b", r"\1\2, then turns \3 degrees"),
    # the foot that goes first, the standing at the start
    (rf"\b(?:and |while )?(?:is |are )?(?:starting|beginning|starts?|begins?|staring|leading)(?: it| first)? (?:with|by|on|of with) "
     rf"{_OWN}{_SIDE}(?: (?:leg|foot|food|feet|one))?(?: first)?\b", " "),
    (rf"\b{_SIDE} (?:foot|leg) first\b", " "),
    (r"\bfrom (?:a )?(?:standing(?: still)?|rest)(?: position| posture)?\b|\bwhile standing\b(?= *$|[.,])", " "),
    (rf"\b({_HOLDING})((?: [a-z]+){{0,4}}?) (?:while )?standing up\b", r"\1\2 while standing"),
    (r"\bon (?:his |her |its |their )?knees (?=(?:is |and )?(?:standing|stands|gets|rises))", " kneeling "),
    (r"\b(?:starts|was|is|sits|sitting|starting) on (?:his |her |its |their )?(?:both )?knees\b", "is kneeling"),
    (r"\bcomes? to (?:an? )?(?:rest|stop|halt|standstill)\b|\bcoming to (?:an? )?(?:rest|stop|halt|standstill)\b|\bbrakes\b", "stops"),
    (r"\b(?:slows?|slowing) down (?:and )?stops\b", "stops"),
    # two verbs of one object
    (rf"\b(rais|lift)(es|ing|s) and (?:lower|drop)(?:s|ing) ({_OWN}(?:{_SIDE} )?(?:arms?|hands?|legs?|foot|feet|knees?))\b",
     r"\1\2 \3"),
    (r"\b(lower|drop|put)s?(?:ing)? (?:it|them|both|his \w+|her \w+|the \w+) (?:back )?(?:down )?(?:again)\b", r"\1s them down"),
    # after a push
    (r"\b(?:gains?|regains?|maintains?|maintaining|keeps?|keeping|finds?|catches) (?:his |her |its |their |the )?balance(?: again)?\b",
     "recovers"),
    (r"\bgets? back (?:on|to|in) (?:his|her|its|their|the) (?:original )?(?:way|track|path|course)\b", "recovers"),
    (r"\bbeeing\b", "being"), (r"\b(?:geht|gests) (?=hit|pushed)", "gets "),
    # what a motion resembles
    (rf"\b(?:makes?|making|does|doing|performs?|performing) (?:an? |some |the )?(?:[a-z]+ ){{0,2}}?{_MOTION} (?:which (?:looks|is|resembles) )?"
     r"(?:like|similar to|as if|as though|resembling|of)(?: (?:he|she|it|they)(?: is| was| were|'s)?)?(?: to)? (?=[a-z]+ing\b)", " "),
    (rf"\b(?:performs?|performing|does|doing|makes?|making) (?:an? |the |some )?([a-z]+ing) {_MOTION}\b", r"\1"),
    (r"\bthe (?:own )?arms? (?=(?:hanging|swinging))", "the arms "),
    (r"\bwith (?:both |his |her |its )*arms (?:hanging|at (?:the|his|her) sides?)(?: down)?\b", " "),
)  # fmt: skip
_COMPILED: list[tuple[re.Pattern[str], str | Callable[[re.Match[str]], str]]] = []


def in_normal_form(text: str) -> str:
    """The sentence in words of the grammar, in lower case; the same one where there is nothing to put otherwise.

    >>> in_normal_form("a person walks in a clockwise circle")
    'a person walks in a circle clockwise'
    """
    if not _COMPILED:
        _COMPILED.extend((re.compile(pattern), replacement) for pattern, replacement in NORMAL_FORMS)
    folded = text.lower()
    for pattern, replacement in _COMPILED:
        folded = pattern.sub(replacement, folded)
    return " ".join(folded.split())
