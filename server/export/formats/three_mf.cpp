#include "export/formats/writers.hpp"

#include <lib3mf/Model/COM/NMR_DLLInterfaces.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "export/formats/text.hpp"

namespace oval4d::exports {

namespace {

using namespace NMR;

void throwOnLib3mfError(LIB3MFRESULT result, const char* what) {
    if (result != LIB3MF_OK) throw std::runtime_error(std::string("lib3mf: ") + what);
}

template <typename Thing>
using Lib3mfPointer = std::unique_ptr<Thing, decltype(&lib3mf_release)>;

// Calls `make(&pointer)`, which creates a lib3mf object, and returns an owning pointer to this object. Throws an
// exception with the message `what` if the call fails.
template <typename Thing, typename Make>
Lib3mfPointer<Thing> makeOwnedLib3mfObject(const char* what, Make&& make) {
    Thing* made = nullptr;
    throwOnLib3mfError(make(&made), what);
    return {made, &lib3mf_release};
}

// A seekable buffer, to which lib3mf writes the file.
struct SeekableBuffer {
    std::string bytes;
    std::size_t at = 0;

    static DWORD write(const void* data, DWORD count, SeekableBuffer* sink) {
        sink->bytes.resize(std::max(sink->bytes.size(), sink->at + count));
        std::copy_n(static_cast<const char*>(data), count, sink->bytes.data() + sink->at);
        sink->at += count;
        return 0;
    }
    static DWORD seek(ULONG64 to, SeekableBuffer* sink) {
        sink->at = to;
        return 0;
    }
};

// A progress callback for lib3mf. Returns false to cancel writing.
bool onWriteProgress(int /*progress*/, ProgressIdentifier /*step*/, void* budget) {
    return !static_cast<const ExportBudget*>(budget)->mustStop();
}

void addMesh(PLib3MFModel* model, const PlacedMesh& solid) {
    std::vector<MODELMESHVERTEX> points;
    points.reserve(solid.mesh.points.size());
    for (const glm::dvec3& p : solid.mesh.points) {
        const glm::vec3 q(p + solid.at);
        points.push_back({{q.x, q.y, q.z}});
    }
    std::vector<MODELMESHTRIANGLE> triangles;
    triangles.reserve(solid.mesh.triangles.size());
    for (const auto& [a, b, c] : solid.mesh.triangles) triangles.push_back({{a, b, c}});
    const auto object = makeOwnedLib3mfObject<PLib3MFModelMeshObject>(
        "cannot create an object", [&](auto** out) { return lib3mf_model_addmeshobject(model, out); });
    throwOnLib3mfError(lib3mf_meshobject_setgeometry(object.get(), points.data(), static_cast<DWORD>(points.size()),
                                                     triangles.data(), static_cast<DWORD>(triangles.size())),
                       "cannot set the mesh");
    throwOnLib3mfError(lib3mf_object_setnameutf8(object.get(), removeNonXmlCharacters(solid.name).c_str()),
                       "cannot name the object");
    makeOwnedLib3mfObject<PLib3MFModelBuildItem>("cannot add the object to the build", [&](auto** out) {
        return lib3mf_model_addbuilditem(model, object.get(), nullptr, out);
    });
}

}  // namespace

std::string threeMf(const MeshesToWrite& meshes) {
    const auto model = makeOwnedLib3mfObject<PLib3MFModel>("cannot create a model",
                                                           [](auto** out) { return lib3mf_createmodel(out); });
    throwOnLib3mfError(lib3mf_model_setunit(model.get(), MODELUNIT_MILLIMETER), "cannot set the unit");
    // Escape the title, because lib3mf escapes names, but not metadata.
    throwOnLib3mfError(lib3mf_model_addmetadatautf8(model.get(), "Title", xmlEscaped(meshes.title).c_str()),
                       "cannot set the title");
    throwOnLib3mfError(lib3mf_model_addmetadatautf8(model.get(), "Application", "oval4d"),
                       "cannot set the application");
    for (const PlacedMesh& solid : meshes.solids) {
        meshes.budget.checkTimeAndStop();
        addMesh(model.get(), solid);
    }
    const auto writer = makeOwnedLib3mfObject<PLib3MFModelWriter>(
        "cannot create a writer", [&](auto** out) { return lib3mf_model_querywriter(model.get(), "3mf", out); });
    throwOnLib3mfError(
        lib3mf_writer_setprogresscallback(writer.get(), &onWriteProgress, const_cast<ExportBudget*>(&meshes.budget)),
        "cannot set the progress callback");
    SeekableBuffer sink;
    const auto result = lib3mf_writer_writetocallback(writer.get(), reinterpret_cast<void*>(&SeekableBuffer::write),
                                                      reinterpret_cast<void*>(&SeekableBuffer::seek), &sink);
    meshes.budget.checkTimeAndStop();
    throwOnLib3mfError(result, "cannot write the file");
    return std::move(sink.bytes);
}

}  // namespace oval4d::exports
