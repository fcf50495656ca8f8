//! Hands: from the image of a hand to features in millimeters, and synthetic scans with ground truth.
