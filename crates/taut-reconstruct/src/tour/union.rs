//! Sets that are joined, and the question whether two elements are of one set.

/// A forest over 0, 1, …; roots are the smallest of their sets.
pub(crate) struct Union {
    parents: Vec<u32>,
}

impl Union {
    /// Each element by itself.
    pub(crate) fn of(n: usize) -> Self {
        Self { parents: (0..n as u32).collect() }
    }

    /// The root of the set; every other step on the way is skipped from then on.
    #[inline(always)]
    pub(crate) fn root(&mut self, mut v: u32) -> u32 {
        loop {
            let parent = self.parents[v as usize];
            if parent == v {
                return v;
            }
            let above = self.parents[parent as usize];
            self.parents[v as usize] = above;
            v = above;
        }
    }

    /// Joins two sets; false if they were one.
    #[inline(always)]
    pub(crate) fn join(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b) as usize] = a.min(b);
        a != b
    }
}
