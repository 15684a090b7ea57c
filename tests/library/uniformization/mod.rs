//! Uniformization of closed surfaces of genus 1 and more, deck groups and universal covers, by theorem.

mod cover;
mod known;
mod lift;
mod polygon;
mod quotient;
mod surfaces;
