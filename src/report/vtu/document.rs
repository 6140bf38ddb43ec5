//! The XML of one unstructured grid, version 1.0, numbers in base64, little endian.

use crate::report::base64;

/// Which entries an array belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Section {
    Points,
    Cells,
}

/// Cells as VTK lists them.
#[derive(Clone, Debug, Default)]
pub(super) struct Cells {
    connectivity: Vec<i64>,
    ends: Vec<i64>,
    kinds: Vec<u8>,
}

impl Cells {
    pub(super) fn push(&mut self, kind: u8, points: impl IntoIterator<Item = usize>) {
        self.connectivity
            .extend(points.into_iter().map(|point| point as i64));
        self.ends.push(self.connectivity.len() as i64);
        self.kinds.push(kind);
    }
}

/// A VTU document in the making: arrays are appended, the grid closes it.
#[derive(Debug)]
pub(super) struct Document {
    text: String,
}

impl Document {
    pub(super) fn new(points: usize, cells: &Cells) -> Self {
        let cells = cells.kinds.len();
        let text = format!(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
             <UnstructuredGrid>\n\
             <Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n"
        );
        Self { text }
    }

    /// An image of one layer of cells below z = 0, origin and sides in metre: readers count none in a
    /// layer without thickness.
    pub(super) fn image(origin: [f64; 2], spacing: [f64; 2], cells: [usize; 2]) -> Self {
        let ([x, y], [dx, dy], [columns, rows]) = (origin, spacing, cells);
        let (extent, dz) = (format!("0 {columns} 0 {rows} 0 1"), dx.min(dy));
        let text = format!(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
             <ImageData WholeExtent=\"{extent}\" Origin=\"{x} {y} -{dz}\" Spacing=\"{dx} {dy} {dz}\">\n\
             <Piece Extent=\"{extent}\">\n"
        );
        Self { text }
    }

    /// Closes an image.
    pub(super) fn finish_image(mut self) -> String {
        self.text += "</Piece>\n</ImageData>\n</VTKFile>\n";
        self.text
    }

    /// Opens a section and appends its arrays.
    pub(super) fn section(&mut self, section: Section, arrays: impl FnOnce(&mut Self)) {
        let tag = match section {
            Section::Points => "PointData",
            Section::Cells => "CellData",
        };
        self.text += &format!("<{tag}>\n");
        arrays(self);
        self.text += &format!("</{tag}>\n");
    }

    /// Appends real numbers, `components` per entry.
    pub(super) fn reals(
        &mut self,
        name: &str,
        components: usize,
        values: impl Iterator<Item = f64>,
    ) {
        self.array(
            "Float64",
            name,
            components,
            values.flat_map(f64::to_le_bytes),
        );
    }

    /// Says something to whoever opens the file.
    pub(super) fn comment(&mut self, words: &str) {
        self.text += &format!("<!-- {words} -->\n");
    }

    /// Appends one whole number per entry.
    pub(super) fn integers(&mut self, name: &str, values: impl Iterator<Item = i32>) {
        self.array("Int32", name, 1, values.flat_map(i32::to_le_bytes));
    }

    /// Appends points and cells and closes the document.
    pub(super) fn finish(
        mut self,
        points: impl Iterator<Item = [f64; 3]>,
        cells: &Cells,
    ) -> String {
        let long = |values: &[i64]| {
            values
                .iter()
                .flat_map(|v| v.to_le_bytes())
                .collect::<Vec<_>>()
        };
        self.text += "<Points>\n";
        self.reals("Points", 3, points.flatten());
        self.text += "</Points>\n<Cells>\n";
        self.array("Int64", "connectivity", 1, long(&cells.connectivity));
        self.array("Int64", "offsets", 1, long(&cells.ends));
        self.array("UInt8", "types", 1, cells.kinds.iter().copied());
        self.text += "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
        self.text
    }

    /// One array: the number of bytes, then the bytes.
    fn array(
        &mut self,
        kind: &str,
        name: &str,
        components: usize,
        values: impl IntoIterator<Item = u8>,
    ) {
        let mut bytes = vec![0; size_of::<u64>()];
        bytes.extend(values);
        let length = (bytes.len() - size_of::<u64>()) as u64;
        bytes[..size_of::<u64>()].copy_from_slice(&length.to_le_bytes());
        self.text += &format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"binary\">\n"
        );
        base64::encode(&bytes, &mut self.text);
        self.text += "\n</DataArray>\n";
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_array_starts_with_its_number_of_bytes() {
        let mut document = Document::new(1, &Cells::default());
        document.integers("state", std::iter::once(7));
        // Eight bytes that say 4, then the four bytes of 7: 16 characters, 6 bits each.
        let coded = document.text.lines().rev().nth(1);
        assert_eq!(coded, Some("BAAAAAAAAAAHAAAA"));
    }
}
