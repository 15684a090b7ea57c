// All of ricci for C++: the classes of every theme. A program that includes one theme only compiles faster:
// ricci/core.hpp (flattening), repair.hpp, uniformize.hpp (with homotopy.h and charts.h), circles.hpp,
// seamless.hpp, quads.hpp, flatten.hpp, freesurfer.hpp, gifti.hpp, harmonic.hpp, match.hpp, moduli.hpp,
// structure.hpp, spline.hpp, bicubic.hpp, quad_spline.hpp, texture.hpp, scene.hpp, archive.hpp.
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_HPP
#define RICCI_HPP

#include <ricci/archive.hpp>
#include <ricci/bicubic.hpp>
#include <ricci/circles.hpp>
#include <ricci/core.hpp>
#include <ricci/flatten.hpp>
#include <ricci/freesurfer.hpp>
#include <ricci/gifti.hpp>
#include <ricci/harmonic.hpp>
#include <ricci/match.hpp>
#include <ricci/moduli.hpp>
#include <ricci/quad_spline.hpp>
#include <ricci/quads.hpp>
#include <ricci/repair.hpp>
#include <ricci/scene.hpp>
#include <ricci/seamless.hpp>
#include <ricci/spline.hpp>
#include <ricci/structure.hpp>
#include <ricci/texture.hpp>
#include <ricci/uniformize.hpp>

#endif
