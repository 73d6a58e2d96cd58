#include "host/hdf5/memory_file.h"

#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <set>

namespace pmdsim {
namespace {

// What HDF5 calls a driver: it reads at addresses, and is asked how far these go.
struct MemoryFile {
  H5FD_t of_hdf5{};                           // first: HDF5 knows the file by it
  Hdf5MemoryFile::Content *content = nullptr; // of the file that is being read, if it still is
  haddr_t end_of_use = 0;
};

// Those that HDF5 has open.
std::set<MemoryFile *> &open_files() {
  static std::set<MemoryFile *> files;
  return files;
}

const MemoryFile &memory_file(const H5FD_t *file) { return *reinterpret_cast<const MemoryFile *>(file); }

H5FD_t *open_memory(const char *, unsigned, hid_t access, haddr_t) {
  const auto *content = static_cast<Hdf5MemoryFile::Content *const *>(H5Pget_driver_info(access));
  if (!content)
    return nullptr;
  try { // no exception may pass through HDF5's C
    auto file = std::make_unique<MemoryFile>(MemoryFile{{}, *content, 0});
    open_files().insert(file.get());
    return reinterpret_cast<H5FD_t *>(file.release());
  } catch (const std::bad_alloc &) {
    return nullptr;
  }
}

herr_t close_memory(H5FD_t *file) {
  const std::unique_ptr<MemoryFile> owned(reinterpret_cast<MemoryFile *>(file));
  open_files().erase(owned.get());
  return 0;
}

herr_t set_end_of_use(H5FD_t *file, H5FD_mem_t, haddr_t end) {
  reinterpret_cast<MemoryFile *>(file)->end_of_use = end;
  return 0;
}

herr_t read_memory(H5FD_t *file, H5FD_mem_t what, hid_t, haddr_t address, std::size_t size, void *to) {
  Hdf5MemoryFile::Content *const content = memory_file(file).content;
  if (!content || address > content->bytes.size() || size > content->bytes.size() - address)
    return -1;
  std::memcpy(to, content->bytes.data() + address, size);
  if (what == H5FD_MEM_DRAW)
    content->value_bytes_read += size;
  return 0;
}

H5FD_class_t memory_driver() {
  H5FD_class_t driver{};
  driver.name = "pmdsim_memory";
  driver.maxaddr = std::numeric_limits<std::int64_t>::max();
  driver.fc_degree = H5F_CLOSE_STRONG;
  driver.fapl_size = sizeof(Hdf5MemoryFile::Content *);
  driver.open = open_memory;
  driver.close = close_memory;
  driver.query = [](const H5FD_t *, unsigned long *features) -> herr_t {
    *features = 0;
    return 0;
  };
  driver.get_eoa = [](const H5FD_t *file, H5FD_mem_t) { return memory_file(file).end_of_use; };
  driver.set_eoa = set_end_of_use;
  driver.get_eof = [](const H5FD_t *file, H5FD_mem_t) -> haddr_t {
    const Hdf5MemoryFile::Content *content = memory_file(file).content;
    return content ? content->bytes.size() : 0;
  };
  driver.read = read_memory;
  driver.write = [](H5FD_t *, H5FD_mem_t, hid_t, haddr_t, std::size_t, const void *) -> herr_t { return -1; };
  constexpr H5FD_mem_t map[] = H5FD_FLMAP_DICHOTOMY;
  std::memcpy(driver.fl_map, map, sizeof(map));
  return driver;
}

// Stays, as HDF5 looks at a driver while it closes the last file of it; anew where somebody closed HDF5.
hid_t driver_id() {
  static const H5FD_class_t driver = memory_driver();
  static hid_t id = -1;
  if (id < 0 || H5Iget_type(id) != H5I_VFL)
    id = H5FDregister(&driver);
  return id;
}

} // namespace

Hdf5MemoryFile::Hdf5MemoryFile(std::string_view bytes)
    : content_{bytes}, access_(H5Pcreate(H5P_FILE_ACCESS), H5Pclose) {
  const Content *const content = &content_;
  if (H5Pset_driver(access_.id(), driver_id(), static_cast<const void *>(&content)) >= 0)
    file_ = {H5Fopen("frame", H5F_ACC_RDONLY, access_.id()), H5Fclose};
}

Hdf5MemoryFile::~Hdf5MemoryFile() {
  file_ = {};
  for (MemoryFile *file : open_files())
    file->content = nullptr;
}

} // namespace pmdsim
