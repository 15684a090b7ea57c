// Bicubic patches near splines, for CAD: C++ ownership and errors, as ricci/ricci.hpp has them.
//
//     const ricci::bicubic patches(surface);
//     patches.write("surface.step");
//
// SPDX-License-Identifier: MIT OR Apache-2.0
#ifndef RICCI_BICUBIC_HPP
#define RICCI_BICUBIC_HPP

#include <ricci/bicubic.h>
#include <ricci/spline.hpp>

namespace ricci {

using bicubic_handle = owned<ricci_bicubic, ricci_bicubic_free>;

// Bicubic patches near a spline.
class bicubic : public bicubic_handle {
public:
    explicit bicubic(const spline &surface,
                     const ricci_bicubic_options &options = init<ricci_bicubic_options>(),
                     const control *watched = nullptr)
        : bicubic_handle(make<ricci_bicubic>(ricci_bicubic_new, surface.get(), &options, of(watched))) {}
    ricci_bicubic_summary summary() const { return ricci::summary(ricci_bicubic_summarise, get()); }
    // Writes the patches in the format of the file's extension: .step, .stp or .json.
    void write(const std::string &path,
               const ricci_step_options &options = init<ricci_step_options>()) const {
        check(ricci_bicubic_write(handle_, &options, path.c_str()));
    }
    std::string text(std::uint32_t format = RICCI_BICUBIC_STEP,
                     const ricci_step_options &options = init<ricci_step_options>()) const {
        return text_of(ricci_bicubic_text, get(), format, &options);
    }
};

} // namespace ricci

#endif
