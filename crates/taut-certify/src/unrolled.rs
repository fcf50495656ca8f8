//! Loops over a few numbers, written out.

/// Repeats a block for `i` below a constant of at most 4, without a loop: crates that are compiled for size keep their loops.
macro_rules! unrolled {
    ($i:ident < $end:expr, $block:block) => {{
        const { assert!($end <= 4) }
        if 0 < $end {
            let $i = 0;
            $block
        }
        if 1 < $end {
            let $i = 1;
            $block
        }
        if 2 < $end {
            let $i = 2;
            $block
        }
        if 3 < $end {
            let $i = 3;
            $block
        }
    }};
}

pub(crate) use unrolled;
