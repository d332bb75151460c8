"""Result files and the tables of the docs made from them."""
