#include "net/jobs/file_reader.hpp"

namespace oval4d::net {

session::FileReader fileReader(const Services& services) {
    return [&readers = services.readers, &data = services.data, stop = services.loadWorkers.stopToken()](
               const session::LoadObject& load, const session::Limits& limits) {
        if (load.dataName.empty()) return readers.read(load, limits, stop);
        return data.read(
            load, limits,
            [&](const session::LoadObject& file, const session::Limits& most,
                const file_reading::FileAllocator& allocate) { return readers.read(file, most, stop, allocate); });
    };
}

}  // namespace oval4d::net
