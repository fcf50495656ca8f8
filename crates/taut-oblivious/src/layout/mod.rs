//! Where the nodes of a tree are put in memory.
//!
//! | you want | use |
//! |---|---|
//! | any binary tree, given by its children, in another order | [`permute`] |
//! | the places of a complete tree in van Emde Boas order, by arithmetic | [`VanEmdeBoasOrder`] |
//! | the ranks of the nodes of a complete tree | [`CompleteTree`] |
//!
//! A walk from the root of a tree touches a new block of memory wherever it leaves the block it is in. Orders differ in how
//! often that happens; the tree, and every answer it gives, stays the same.

mod complete;
mod permute;
mod veb;

pub use complete::CompleteTree;
pub use permute::{NONE, Permuted, TreeOrder, permute};
pub use veb::{VanEmdeBoasOrder, Walk};
