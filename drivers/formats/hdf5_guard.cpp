#include "drivers/formats/hdf5_guard.h"

#include <hdf5.h>

namespace framewatch::drivers {
namespace {

/// A handle of the library, closed at the end of its scope.
class Hdf5Handle {
 public:
  Hdf5Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Hdf5Handle() {
    if (good()) close_(id_);
  }
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  hid_t id() const { return id_; }
  bool good() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// 0: go on; anything else ends the visit.
herr_t look_at_link(hid_t group, const char* name, const H5L_info_t* link, void* /*unused*/) {
  if (link->type == H5L_TYPE_SOFT) return 0;
  if (link->type != H5L_TYPE_HARD) return 1;
  const Hdf5Handle object(H5Oopen(group, name, H5P_DEFAULT), &H5Oclose);
  if (!object.good()) return 1;
  if (H5Iget_type(object.id()) != H5I_DATASET) return 0;
  const Hdf5Handle made(H5Dget_create_plist(object.id()), &H5Pclose);
  if (!made.good()) return 1;
  return H5Pget_external_count(made.id()) != 0 || H5Pget_layout(made.id()) == H5D_VIRTUAL ? 1 : 0;
}

}  // namespace

bool hdf5_is_of_one_file(const std::string& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), &H5Fclose);
  return file.good() &&
         H5Lvisit(file.id(), H5_INDEX_NAME, H5_ITER_NATIVE, &look_at_link, nullptr) == 0;
}

}  // namespace framewatch::drivers
