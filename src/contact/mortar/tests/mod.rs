//! Tests of whole sides: plane, curved, covered in part, several at once; and the sides they share.

mod curved_faces;
mod partly_covered;
mod plane_faces;
mod several_faces;
mod sides;
