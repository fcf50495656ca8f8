//! What stands beside pictures, and which pictures say something.

use taut_draw::Figure;

use crate::Field;

/// A field as a page shows it.
impl From<Field> for taut_draw::Field {
    fn from(field: Field) -> Self {
        taut_draw::Field::new(field.name, field.value)
    }
}

/// The pictures without charts of a single value, such as the gap by pass after one pass.
pub fn worth_drawing(figures: Vec<Figure>) -> Vec<Figure> {
    let tells = |figure: &Figure| match figure {
        Figure::Plot(plot) => {
            !plot.bars.is_empty() || plot.series.iter().any(|series| series.points.len() > 1)
        }
        _ => true,
    };
    figures.into_iter().filter(tells).collect()
}
