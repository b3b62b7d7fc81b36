// SPDX-License-Identifier: GPL-3.0-or-later
// What the module offers, under the name by which it is looked up.
#include "src/import/import_module.h"
#include "src/import/module/hdf5_log.h"
#include "src/import/module/mat_log.h"
#include "src/import/module/rosbag2_log.h"

namespace fidservo::imports {

extern "C" {
extern const ImportModule fidservo_import_module;
const ImportModule fidservo_import_module{read_mat_file, read_hdf5_file, read_rosbag2_files, write_mat_file,
                                          write_hdf5_file};
}

}  // namespace fidservo::imports
