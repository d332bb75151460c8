"""The class of each pixel: masks from files, by the built-in segmenter and by pretrained ones."""
