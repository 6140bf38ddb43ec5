//! Tests of whole sides: plane, curved, several at once; and the sides they share.

mod curved_faces;
mod plane_faces;
mod several_faces;
mod sides;
