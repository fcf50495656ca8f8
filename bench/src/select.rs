//! Which cases the words of a command line mean.

use anyhow::{Result, ensure};

/// The items whose names are meant by one of `words`, in their order; without words all of them.
///
/// A word means an item by its whole name, so that `balls-10` is not also `balls-100`, or, where no item has that name,
/// by the beginning of it.
///
/// # Errors
/// When a word means none; `area` then says where the list is.
pub(crate) fn select<'a, T>(
    items: &'a [T],
    name: impl Fn(&T) -> &str,
    words: &[String],
    area: &str,
) -> Result<Vec<&'a T>> {
    let means = |word: &str, item: &T| match items.iter().any(|item| name(item) == word) {
        true => name(item) == word,
        false => name(item).starts_with(word),
    };
    for word in words {
        let known = items.iter().any(|item| means(word, item));
        ensure!(known, "no case begins with `{word}`: see `bench {area} --list`");
    }
    let meant = |item: &&T| words.is_empty() || words.iter().any(|word| means(word, item));
    Ok(items.iter().filter(meant).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_whole_name_means_that_case_alone() {
        let names = ["balls-3", "balls-10", "balls-100", "small"];
        let meant = |words: &[&str]| {
            let words: Vec<String> = words.iter().map(|word| word.to_string()).collect();
            select(&names, |name| name, &words, "ball").map(|found| found.len())
        };
        assert_eq!(meant(&["balls-10"]).unwrap(), 1);
        assert_eq!(meant(&["balls"]).unwrap(), 3);
        assert_eq!(meant(&["small", "balls-3"]).unwrap(), 2);
        assert_eq!(meant(&[]).unwrap(), 4);
        let refused = meant(&["small", "none"]).unwrap_err().to_string();
        assert_eq!(refused, "no case begins with `none`: see `bench ball --list`");
    }
}
