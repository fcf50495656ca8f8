//! Pictures of the answers of taut: SVG, PNG and interactive HTML.
