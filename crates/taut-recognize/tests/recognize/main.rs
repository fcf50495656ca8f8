//! Classifiers, error rates, hands, and the store of people.

mod classify;
mod evaluate;
#[cfg(feature = "hand")]
mod hand_distance;
#[cfg(feature = "hand")]
mod hand_help;
#[cfg(feature = "photographs")]
mod hand_image;
#[cfg(feature = "hand")]
mod hand_masks;
#[cfg(feature = "hand")]
mod hand_scans;
#[cfg(feature = "store")]
mod store;
mod template_index;
mod test_length;
