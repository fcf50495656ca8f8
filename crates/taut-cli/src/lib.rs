//! The taut command: tight shapes of point sets, with proof.
