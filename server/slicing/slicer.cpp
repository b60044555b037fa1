#include "slicing/slicer.hpp"

#include "slicing/visitor.hpp"

namespace oval4d::slicing {

void Slicer::slice(const Object& object, const geometry::Rotation& orientation, const geometry::Hyperplanes& planes,
                   SliceSet& out) {
    const parallel::OneAtATime::Use use(inUse_);
    out.ballScale.clear();
    out.ballOpacity.clear();
    std::visit(Visitor{[&](const PolytopePtr& p) { polytopes_.slice(*p, orientation, planes, out); },
                       [&](const CloudPtr& cloud) { clouds_.slice(*cloud, orientation, planes, out); }},
               object);
}

}  // namespace oval4d::slicing
