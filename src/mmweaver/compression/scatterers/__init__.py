"""A radar sequence as point scatterers over a static background."""
