//! Parts that are joined one by one, with a sign: union-find with parity.

/// Nodes in parts, and whether each is opposite to the root of its part.
pub(super) struct ParityUnionFind {
    /// Parent, and whether opposite to it in the lowest bit.
    link: Vec<u32>,
}

impl ParityUnionFind {
    pub(super) fn new(count: usize) -> Self {
        Self { link: (0..count as u32).map(|node| node << 1).collect() }
    }

    /// The root of a node, and in the lowest bit whether the node is opposite to it.
    pub(super) fn root(&mut self, node: u32) -> u32 {
        let (mut node, mut parity) = (node, 0);
        loop {
            let link = self.link[node as usize];
            let parent = link >> 1;
            if parent == node {
                return link ^ parity;
            }
            // Halves the way: the parent of the parent, with the parity of both steps. A root is its own parent, in parity 0.
            let above = self.link[parent as usize] ^ (link & 1);
            self.link[node as usize] = above;
            parity ^= above & 1;
            node = above >> 1;
        }
    }

    /// Joins the parts of two nodes, if they are two, the higher root to the lower; says whether they were.
    pub(super) fn join(&mut self, one: u32, other: u32, is_opposite: bool) -> bool {
        let (a, b) = (self.root(one), self.root(other));
        if a >> 1 == b >> 1 {
            return false;
        }
        let (lower, higher) = (a.min(b), a.max(b));
        self.link[(higher >> 1) as usize] = lower ^ (higher & 1) ^ u32::from(is_opposite);
        true
    }

    /// Numbers the parts by their lowest nodes: for each node that of its part, and in the lowest bit whether the node is opposite to
    /// the root of its part; and how many parts there are.
    pub(super) fn numbered(mut self) -> (Vec<u32>, usize) {
        let mut parts = 0;
        for node in 0..self.link.len() {
            let link = self.link[node];
            let parent = (link >> 1) as usize;
            // Parents have lower numbers, and are numbered already.
            self.link[node] = if parent == node {
                parts += 1;
                (parts - 1) << 1
            } else {
                self.link[parent] ^ (link & 1)
            };
        }
        (self.link, parts as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opposites_of_opposites_are_alike() {
        let mut parity = ParityUnionFind::new(6);
        assert!(parity.join(4, 5, true) && parity.join(3, 4, true) && parity.join(0, 1, false));
        assert!(!parity.join(3, 5, true), "joined already");
        assert!(parity.join(1, 5, true));
        assert_eq!(parity.numbered(), (vec![0, 0, 2, 1, 0, 1], 2));
    }
}
