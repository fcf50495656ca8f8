//! Classifiers behind one trait: learn from labelled points, then tell the label of new ones.
