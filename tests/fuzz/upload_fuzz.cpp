// Fuzzes the header of uploads of fields. The input has two lines: the method and the target of an HTTP request.

#include "net/http/request_target.hpp"
#include "net/http/upload.hpp"
#include "support.hpp"

using namespace oval4d;
using fuzz::require;

namespace {

void requireSound(const net::UploadRequest& upload, std::string_view method, std::string_view path) {
    if (!upload.load) {
        require(method == "PUT" && path.ends_with("/sessions/" + upload.session + "/state"),
                "a state is put at its path");
        return;
    }
    const session::LoadObject& load = *upload.load;
    require(path.find("/sessions/" + upload.session + "/fields/" + load.name) != std::string_view::npos,
            "the session and the name are those in the path:", path);
    require(upload.session.find('/') == std::string::npos, "a session is one part of the path:", upload.session);
    require(load.append == (method == "POST"), "POST adds moments, and PUT does not");
    require(!load.append || path.ends_with("/moments"), "moments are added at their own path:", path);
    require(load.format.empty() || session::isArrayFormat(load.format), "only arrays are uploaded:", load.format);
    require(load.data.empty() && load.dataName.empty() && !load.isArrayInFiles(), "the file is only in the body");
    session::LoadObject checked = load;
    if (checked.format.empty()) checked.format = "npy";
    require(!session::checkLoad(checked, fuzz::kLimits), "what is received can be loaded");
}

}  // namespace

OVAL4D_FUZZER(upload) {
    std::string_view rest = fuzz::textOf(data, size);
    const std::string_view method = fuzz::takeUntil(rest, '\n');
    const auto target = net::parseRequestTarget(rest);
    if (!target || !net::isUpload(method, target->path)) return 0;
    const auto upload = net::parseUpload(method, *target, fuzz::kLimits);
    if (upload) {
        requireSound(*upload, method, target->path);
    } else {
        fuzz::requireSentence(upload.error());
        require(net::uploadErrorReply(upload.error()).status >= 400, "an error has the status of an error");
    }
    return 0;
}
