//! A number per block of the simulated address space, for those that were ever set.
//!
//! Idea: the space is dense, so a table in pages serves where a hash map would; pages nobody accessed are not there.

const PAGE: usize = 1 << 12;

/// Maps block numbers to numbers other than 0; 0 stands for none.
#[derive(Clone, Debug, Default)]
pub(super) struct Table {
    pages: Vec<Option<Box<[u32; PAGE]>>>,
}

impl Table {
    #[inline]
    pub(super) fn get(&self, block: u64) -> u32 {
        match self.pages.get((block / PAGE as u64) as usize) {
            Some(Some(page)) => page[block as usize % PAGE],
            _ => 0,
        }
    }

    #[inline]
    pub(super) fn set(&mut self, block: u64, value: u32) {
        let number = (block / PAGE as u64) as usize;
        if number >= self.pages.len() {
            self.pages.resize_with(number + 1, || None);
        }
        let page = self.pages[number].get_or_insert_with(|| Box::new([0; PAGE]));
        page[block as usize % PAGE] = value;
    }
}
