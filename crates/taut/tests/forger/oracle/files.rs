//! The oracle of files: their bytes, compared record by record, element by element and line by line.

use taut::certify::{
    AnyFileSolution, DrawnSample, ElementOrder, FileVerdict, KeyKind, SortedFile, TransposedFile,
};
use taut::oblivious::sample;

use super::Truth;

/// Judges every claim of an accepted answer about the bytes of the files. `honest` is the output that the honest document with
/// the same hash is about, whose input is not there: two files of one hash are equal as multisets, or elements by place.
pub fn judge(
    solution: &AnyFileSolution,
    verdict: &FileVerdict,
    input: Option<&[u8]>,
    output: &[u8],
    honest: &[u8],
) -> Truth {
    let compared = input.is_some();
    let first = Truth::claim(verdict.compared == compared, || "compared is wrong".into());
    first.and(|| match solution {
        AnyFileSolution::Sort(found) => sorted(&found.answer, verdict, input, output, honest),
        AnyFileSolution::Transpose(found) => {
            transposed(&found.answer, verdict, input, output, honest)
        }
        AnyFileSolution::Sample(found) => {
            drawn(&found.answer, found.certificate.seed, verdict, output)
        }
        _ => Truth::Undecided("no oracle knows this kind".into()),
    })
}

fn sorted(
    file: &SortedFile,
    verdict: &FileVerdict,
    input: Option<&[u8]>,
    output: &[u8],
    honest: &[u8],
) -> Truth {
    let width = file.width as usize;
    let is_number = file.key_kind != KeyKind::Bytes;
    let [start, end] = file.key.map(|byte| byte as usize);
    let claims = [
        (width > 0 && file.width <= 1 << 24, "the width is no width"),
        (start < end && end <= width, "the key is not within the record"),
        (!is_number || end - start == 8, "a number is a key of eight bytes"),
        (output.len() as u128 == file.width as u128 * file.records as u128, "the length is wrong"),
        (verdict.items == file.records, "the number of records is another one"),
    ];
    if let Some((_, lie)) = claims.iter().find(|(holds, _)| !holds) {
        return Truth::False((*lie).into());
    }
    let key = |record: &[u8]| -> (i128, Vec<u8>) {
        let bytes = &record[start..end];
        let word = || u64::from_le_bytes(bytes.try_into().expect("eight bytes"));
        match file.key_kind {
            KeyKind::U64 => (word().into(), vec![]),
            KeyKind::I64 => ((word() as i64).into(), vec![]),
            // Negative numbers in reverse, before the others.
            KeyKind::F64 => match word() {
                bits if bits >> 63 == 1 => (-1 - i128::from(bits & !(1 << 63)), vec![]),
                bits => (bits.into(), vec![]),
            },
            KeyKind::Bytes => (0, bytes.to_vec()),
        }
    };
    let records: Vec<&[u8]> = output.chunks_exact(width).collect();
    if records.windows(2).any(|pair| key(pair[0]) > key(pair[1])) {
        return Truth::False("the records are not in order".into());
    }
    let multiset = |bytes: &[u8]| {
        let mut records: Vec<Vec<u8>> = bytes.chunks(width).map(<[u8]>::to_vec).collect();
        records.sort();
        records
    };
    Truth::claim(multiset(output) == multiset(input.unwrap_or(honest)), || {
        "the records are not those of the input".into()
    })
}

fn transposed(
    file: &TransposedFile,
    verdict: &FileVerdict,
    input: Option<&[u8]>,
    output: &[u8],
    honest: &[u8],
) -> Truth {
    let bytes = u128::from(file.rows) * u128::from(file.columns) * u128::from(file.width);
    let ends = |data: &[u8], offset: u64| data.len() as u128 == u128::from(offset) + bytes;
    let claims = [
        (file.width > 0, "elements have no bytes"),
        (ends(output, file.output_offset), "the output has another length"),
        (input.is_none_or(|input| ends(input, file.input_offset)), "the input has another length"),
        (
            verdict.items == file.rows.saturating_mul(file.columns),
            "the number of elements is wrong",
        ),
    ];
    if let Some((_, lie)) = claims.iter().find(|(holds, _)| !holds) {
        return Truth::False((*lie).into());
    }
    let width = file.width as usize;
    let written = &output[file.output_offset as usize..];
    let Some(input) = input else {
        // By the hash alone, the elements are those of the honest file.
        return Truth::claim(honest.ends_with(written), || "the elements are others".into());
    };
    let read = &input[file.input_offset as usize..];
    let element =
        |data: &[u8], number: u64| -> Vec<u8> { data[number as usize * width..][..width].to_vec() };
    let (rows, columns) = (file.rows, file.columns);
    let places = (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j)));
    let wrong = places.into_iter().find(|&(i, j)| {
        let from = match file.order {
            ElementOrder::Rows => i * columns + j,
            ElementOrder::Columns => j * rows + i,
        };
        element(read, from) != element(written, j * rows + i)
    });
    Truth::claim(wrong.is_none(), || format!("element {wrong:?} is another one"))
}

fn drawn(file: &DrawnSample, seed: u64, verdict: &FileVerdict, output: &[u8]) -> Truth {
    let Ok(text) = std::str::from_utf8(output) else {
        return Truth::False("the numbers are no text".into());
    };
    let lines: Result<Vec<u64>, _> = text.lines().map(str::parse).collect();
    let Ok(numbers) = lines else {
        return Truth::False("a line is no number".into());
    };
    let claims = [
        (verdict.items == file.drawn, "the number of numbers is another one"),
        (numbers.len() as u64 == file.drawn, "there are more numbers, or fewer"),
        (numbers.windows(2).all(|pair| pair[0] < pair[1]), "the numbers are not in order"),
        (numbers.iter().all(|&number| number < file.of), "a number is out of range"),
        (
            sample(seed, file.of, file.drawn).is_ok_and(|drawn| drawn == numbers),
            "the seed gives other numbers",
        ),
    ];
    let lie = claims.iter().find(|(holds, _)| !holds);
    Truth::claim(lie.is_none(), || lie.map_or(String::new(), |(_, lie)| (*lie).into()))
}
