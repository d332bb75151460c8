"""What each pixel shows: class masks from files, our own segmenter and pretrained ones."""
