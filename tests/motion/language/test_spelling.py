from mmweaver.motion.language.spelling import correct_spelling, corrected_word


def test_slips_are_mended_and_told():
    text, notes = correct_spelling("a person wlaks forwads")
    assert text == "a person wlaks forwards"
    assert notes == ["'forwads' is read as 'forwards'"]
    assert corrected_word("backwrads") == "backwards"
    assert corrected_word("wawing") == "waving"


def test_other_words_stay_as_they_are():
    for word in ("singing", "showing", "passes", "shaved", "walk", "bakes", "licking"):
        assert corrected_word(word) == ""


def test_forms_of_other_verbs_are_no_slips():
    for word in ("talking", "cooking", "climbing", "wishing", "stirring", "swinging", "slides"):
        assert corrected_word(word) == ""


def test_forms_of_words_in_phrases_are_no_slips():
    for word in ("combing", "extension", "folded", "crosses"):
        assert corrected_word(word) == ""
