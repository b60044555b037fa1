#pragma once

#include <array>
#include <cstdint>

#include "text/choice.hpp"

namespace oval4d::exports {

/// The contents of an exported file. protocol/export_formats.json lists the contents that each format allows.
enum class ExportContentsKind : std::uint8_t {
    focus,      ///< only the focus slice
    oval,       ///< all slices
    highlight,  ///< only the highlighted element
    /// The values of w at which the section changes its type (see slicing::findCriticalSections()).
    critical,
    object,       ///< the whole rotated 4-D object
    coordinates,  ///< the parallel coordinates or, for a field, the histogram
    projection,   ///< the projection of the whole object
    matrix        ///< the matrix of planar sections
};

inline constexpr auto kExportContents =
    text::completeTable<text::NamedValue<ExportContentsKind>>({{"focus", ExportContentsKind::focus},
                                                               {"oval", ExportContentsKind::oval},
                                                               {"highlight", ExportContentsKind::highlight},
                                                               {"critical", ExportContentsKind::critical},
                                                               {"object", ExportContentsKind::object},
                                                               {"coordinates", ExportContentsKind::coordinates},
                                                               {"projection", ExportContentsKind::projection},
                                                               {"matrix", ExportContentsKind::matrix}});
constexpr const auto& choicesOf(ExportContentsKind /*type*/) { return kExportContents; }

}  // namespace oval4d::exports
