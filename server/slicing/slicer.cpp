#include "slicing/slicer.hpp"

#include "slicing/overloaded.hpp"

namespace oval4d::slicing {

void Slicer::slice(const Object& object, const geometry::Rotation& orientation, const geometry::Hyperplanes& planes,
                   const FieldSettings& settings, const SurfaceDetail& detail, SliceSet& out) {
    const parallel::ExclusiveUseAssertion::ScopedUse use(inUse_);
    out.ballScale.clear();
    out.ballOpacity.clear();
    if (fieldIn(object) == nullptr) {
        out.surfaces.clear();
        out.fogs.clear();
    }
    std::visit(
        Overloaded{
            [&]<std::derived_from<geometry::CellComplex> Complex>(const std::shared_ptr<const Complex>& complex) {
                complexes_.slice(*complex, orientation, planes, out);
            },
            [&](const CloudPtr& cloud) { clouds_.slice(*cloud, orientation, planes, out); },
            [&](const FieldPtr& field) { fields_.slice(*field, orientation, planes, settings, detail, out); }},
        object);
}

void Slicer::sliceWithoutSurfaces(const Object& object, const geometry::Rotation& orientation,
                                  const geometry::Hyperplanes& planes, SliceSet& out) {
    static const FieldSettings anySettings;  // static, because each construction would allocate memory
    slice(object, orientation, planes, anySettings, {}, out);
}

}  // namespace oval4d::slicing
