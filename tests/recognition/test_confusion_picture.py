"""The largest confusions, by the share of a label's windows."""

from mmweaver.recognition.confusion_picture import largest_confusions


def test_confusions_are_shares_of_the_true_label():
    truth, guess = "a" * 10 + "b" * 4 + "c" * 5, "a" * 7 + "b" * 3 + "bbcc" + "c" * 5
    assert largest_confusions(truth, guess, 5) == [("b", "c"), ("a", "b")]
    assert largest_confusions(truth, guess, 1) == [("b", "c")]
    assert largest_confusions(truth, truth, 5) == []
