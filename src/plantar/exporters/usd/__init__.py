"""USD: the bushes as a layer to reference, or as overs on a robot's own stage."""
