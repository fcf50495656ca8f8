//! Classifiers behind one trait: learn from labeled points, then tell the label of new ones.
