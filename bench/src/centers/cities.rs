//! Cities of `$TAUT_DATA/ball`, and permutations of rows.

use super::*;

/// The places of a file of `$TAUT_DATA/ball`, two numbers each; `None`, after saying so, where it is missing.
pub(crate) fn read(name: &str) -> Result<Option<Vec<f64>>> {
    Ok(data::read_xz(&format!("ball/{name}"))?.map(|text| places(&text)))
}

/// The last two numbers of each line that is made of two numbers or more: TSPLIB's head has words in its lines, and its rows
/// begin with the number of the city.
fn places(text: &str) -> Vec<f64> {
    let numbers = |line: &str| -> Option<Vec<f64>> {
        line.split_whitespace().map(|word| word.parse().ok()).collect()
    };
    let rows = text.lines().filter_map(numbers).filter(|row| row.len() >= 2);
    rows.flat_map(|row| row[row.len() - 2..].to_vec()).collect()
}

/// The rows in an order that the seed determines.
pub(super) fn permuted(values: &[f64], dim: usize, seed: u64) -> Result<Vec<f64>> {
    let order = shuffled(values.len() / dim, seed)?;
    Ok(order.into_iter().flat_map(|row| &values[row * dim..][..dim]).copied().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_and_numbers_of_cities_are_no_places() {
        let text = "DIMENSION: 2\nNODE_COORD_SECTION\n1 5826 1350\n2 413 10751.5\nEOF\n";
        assert_eq!(places(text), [5826.0, 1350.0, 413.0, 10751.5]);
        assert_eq!(places("1.5 2\n3 4\n"), [1.5, 2.0, 3.0, 4.0]);
    }

    #[test]
    fn a_permutation_keeps_the_rows_and_depends_on_the_seed() {
        let values: Vec<f64> = (0..200).map(f64::from).collect();
        let [first, again, second] = [1, 1, 2].map(|seed| permuted(&values, 2, seed).unwrap());
        assert_eq!(first, again);
        assert!(first != second && first != values);
        let mut rows: Vec<&[f64]> = first.chunks(2).collect();
        rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert_eq!(rows.concat(), values);
    }
}
